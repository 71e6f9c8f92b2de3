// Runs the scenarios whose name contains the argument and prints TAP. AUXSHELL is the command, AUXSHELL_ROOT the repository.
import { launch } from "./studio.mjs";
import { scenarios } from "./scenarios.mjs";

const wanted = Object.entries(scenarios).filter(([name]) => name.includes(process.argv[2] ?? ""));
console.log(`1..${wanted.length}`);
const browser = await launch();
let failed = 0;
for (const [k, [name, run]] of wanted.entries()) {
    const began = performance.now();
    const limit = new Promise((_, reject) => setTimeout(() => reject(new Error("no end after 300 s")), 300000).unref());
    try {
        await Promise.race([run(browser, (text) => console.log(`# ${text}`)), limit]);
        console.log(`ok ${k + 1} - ${name}`);
        console.log(`# ${((performance.now() - began) / 1000).toFixed(1)} s`);
    } catch (error) {
        failed++;
        console.log(`not ok ${k + 1} - ${name}`);
        console.log(String(error.stack ?? error).replace(/^/gm, "    # "));
    }
}
await browser.close();
process.exit(failed ? 1 : 0);
