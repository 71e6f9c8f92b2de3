// Pictures of the studio at work: the gallery's into studio/public/examples, those of the README into docs/pictures.
// Started by hand after what they show has changed: cd build/studio && AUXSHELL=$PWD/../release/bin/auxshell AUXSHELL_ROOT=$PWD/../.. node e2e/pictures.mjs
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Hand, Studio, launch } from "./studio.mjs";

const root = process.env.AUXSHELL_ROOT;
const gallery = join(root, "studio/public/examples");
const pictures = join(root, "docs/pictures");
mkdirSync(gallery, { recursive: true });

const browser = await launch();
let studio = await new Studio().start(".");
try {
    const card = await Hand.open(browser, studio.address, { viewport: { width: 1100, height: 760 }, deviceScaleFactor: 1, refines: true });
    await card.key("2");
    for (const { name } of await card.page.evaluate(() => auxshell.session.hello.value.examples)) {
        await card.page.evaluate((example) => auxshell.session.command("new", { example }), name);
        await card.rest();
        await card.page.waitForFunction(() => auxshell.stage.value.atRest); // shadows are drawn then
        const bytes = await card.page.evaluate(async () => {
            const stage = auxshell.stage.value;
            const whole = await createImageBitmap(await stage.picture(false));
            const out = document.createElement("canvas");
            [out.width, out.height] = [480, 292];
            const scale = Math.max(480 / whole.width, 292 / whole.height);
            out.getContext("2d").drawImage(whole, (480 - whole.width * scale) / 2, (292 - whole.height * scale) / 2, whole.width * scale, whole.height * scale);
            const blob = await new Promise((resolve) => out.toBlob(resolve, "image/webp", 0.8));
            return [...new Uint8Array(await blob.arrayBuffer())];
        });
        writeFileSync(join(gallery, `${name}.webp`), Buffer.from(bytes));
    }
    await card.page.context().close();

    for (const colorScheme of ["light", "dark"]) {
        await studio.remove();
        studio = await new Studio().start(".");
        const hand = await Hand.open(browser, studio.address, { viewport: { width: 1600, height: 1000 }, colorScheme, refines: true });
        const shot = async (name) => {
            await hand.page.waitForFunction(() => auxshell.stage.value?.atRest ?? true, null, { timeout: 60000 });
            await hand.page.screenshot({ path: join(pictures, `studio-${name}.png`) });
        };
        await hand.key("b");
        await hand.page.mouse.move(...(await hand.flat(0.6, 0.42)));
        if (colorScheme === "dark") {
            await shot("dark");
            continue;
        }
        await shot("design");
        if ((await hand.page.evaluate(() => auxshell.session.status.value.state)) !== "exact") await hand.key("Control+Enter");
        await hand.page.waitForFunction(() => auxshell.session.status.value?.state === "exact", null, { timeout: 120000 });
        await hand.rest();
        await hand.key("v");
        await hand.key("Alt+2");
        await shot("forces");
        await hand.key("Alt+1");
        await hand.key("Control+e");
        await hand.page.getByRole("img", { name: /holds/ }).waitFor();
        await shot("export");
        await hand.key("Escape");
        await hand.key("Control+Alt+n");
        await shot("start");
        await hand.page.context().close();
    }
} finally {
    await browser.close();
    await studio.remove();
}
