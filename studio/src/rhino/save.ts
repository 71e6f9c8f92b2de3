// The design as a Rhino document, made from the design's JSON and handed to the browser to save.
import type { ExportedFile } from "../protocol/types";
import { download } from "../state/commands";
import { ask, documentState } from "../state/session";

export async function saveRhino(): Promise<void> {
    const answer = await ask("export", { ending: ".json" });
    const design = await (await fetch((answer.files as ExportedFile[])[0].url)).json();
    const worker = new Worker(new URL("./rhino-worker.ts", import.meta.url), { type: "module", name: "rhino" });
    try {
        const made = await new Promise<{ bytes?: Uint8Array<ArrayBuffer>; problem?: string }>((resolve, reject) => {
            worker.onmessage = (event) => resolve(event.data);
            worker.onerror = (event) => reject(new Error(event.message));
            worker.postMessage({ design, shown: "deployed" });
        });
        if (!made.bytes) throw new Error(made.problem);
        download(URL.createObjectURL(new Blob([made.bytes], { type: "model/vnd.3dm" })), `${documentState.value?.name ?? "shell"}.3dm`);
    } finally {
        worker.terminate();
    }
}
