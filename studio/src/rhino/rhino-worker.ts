// Makes the Rhino document apart from the page: the library weighs megabytes, and needs rights that the page does not have.
import load from "rhino3dm/rhino3dm.module.js";
import wasm from "rhino3dm/rhino3dm.wasm?url";
import { type DesignFile, type DesignState, rhinoFile } from "./design";

addEventListener("message", async (event: MessageEvent<{ design: DesignFile; shown: DesignState }>) => {
    try {
        const rhino = await load({ locateFile: () => new URL(wasm, import.meta.url).href });
        postMessage({ bytes: rhinoFile(rhino, event.data.design, event.data.shown) });
    } catch (error) {
        postMessage({ problem: String(error) });
    }
});
