// usage: node serve.js [PORT]: shows build/web
import { serve } from "./test/browser.js";

const { address } = await serve(Number(process.argv[2] ?? 8000));
console.log(`the playground: ${address}`);
