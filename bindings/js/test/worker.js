import { parentPort, workerData } from "node:worker_threads";
import { load } from "../voxtet.js";
import { block } from "./scenes.js";

const vox = await load({ wasm: workerData });
const grid = new vox.Grid();
grid.add(block(4));
grid.add(block(4, [0.7, 0.31, 0.17]));
grid.step();
const vertices = grid.contacts.vertex;
parentPort.postMessage([grid.hash, vertices], [vertices.buffer]);
