// Keys reach the tool first, then the commands. Text fields keep theirs, and so do controls that use arrows or Space.
import { commandFor } from "../state/commands";
import { dialog, page } from "../state/view";
import { tool } from "../tools";

const typing = (target: Element | null) =>
    target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.type !== "checkbox" && target.type !== "range");
const ownKeys = new Set(["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", " ", "Enter"]);

export function listenToKeys(): void {
    window.addEventListener("keydown", (event) => {
        if (event.defaultPrevented || event.isComposing || dialog.value !== null) return;
        const target = event.target as Element | null;
        const modified = event.ctrlKey || event.metaKey || event.altKey;
        if (typing(target) && !modified) return;
        if (target !== document.body && ownKeys.has(event.key) && !modified && (target instanceof HTMLButtonElement || target instanceof HTMLInputElement || target?.getAttribute("role") === "separator")) return;
        if (page.value === "work" && tool.value.key?.(event)) {
            event.preventDefault();
            return;
        }
        const command = commandFor(event);
        if (!command || (page.value === "start" && command.group !== "File" && command.id !== "shortcuts" && command.id !== "theme")) return;
        // the browser's own undo belongs to the text field
        if (typing(target) && command.group === "Edit") return;
        event.preventDefault();
        if (command.when?.() !== false) command.run();
    });
}
