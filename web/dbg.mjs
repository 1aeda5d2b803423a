import { launch, serve } from "./test/browser.js";
const server = await serve(); const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1180, height: 760 } });
page.on("console", m => console.log("console", m.type(), m.text().slice(0,200))); page.on("pageerror", e => console.log("error", String(e)));
await page.goto(server.address + "?scene=empty&stopped");

const show = async (what) => console.log(what, JSON.stringify(await page.evaluate(() => [document.getElementById("log").textContent.slice(0,300), playground.facts, playground.hash, playground.curves && Object.values(playground.curves).map(c=>[c.size,c.ms,c.zone]), playground.measured])));
await new Promise(r => setTimeout(r, 1500)); await show("start");
await page.evaluate(() => { for (const k of [0,1,2,3,4]) playground.act("drop", {kind:k, tets:1000}); });
await new Promise(r => setTimeout(r, 1500)); await show("dropped");
console.log(JSON.stringify(await page.evaluate(() => playground.ask("run", {steps:200}))));
await new Promise(r => setTimeout(r, 2500)); await show("run");
await page.screenshot({path: "/tmp/page.png"});
await browser.close(); server.close();
