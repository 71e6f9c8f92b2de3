import { effect, useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { announcement } from "../state/commands";
import { closedMessage, command, connection, documentState, making, problem, progress, report, status, tell } from "../state/session";
import { darkTheme, tourSeen } from "../state/settings";
import { dialog, mode, page, tourStep } from "../state/view";
import { Bar } from "./bar";
import { Checks } from "./checks";
import { Button, Tool } from "./controls";
import { OpenDialog, SaveDialog, ShortcutsDialog, TableDialog } from "./dialogs";
import { ExportDialog } from "./export";
import { number } from "./format";
import { Icon } from "./icons";
import { Inspector } from "./inspector";
import { Rail } from "./rail";
import { StartPage } from "./start";
import { SurfaceDialog, takeFile } from "./surface";
import { Timeline } from "./timeline";
import { Tour } from "./tour";
import { VariantsPage } from "./variants";
import { Views } from "./views";

export function App() {
    const dropping = useSignal(false);
    useEffect(() => {
        document.documentElement.dataset.theme = darkTheme.value ? "dark" : "light";
    }, [darkTheme.value]);
    const ready = documentState.value !== null && report.value !== null;
    useEffect(() => {
        if (ready && !tourSeen.value && page.value === "work") tourStep.value = 0;
    }, [ready]);
    useEffect(() => {
        const hasFiles = (e: DragEvent) => e.dataTransfer?.types.includes("Files") ?? false;
        const over = (e: DragEvent) => {
            if (!hasFiles(e)) return;
            e.preventDefault();
            dropping.value = true;
        };
        const leave = (e: DragEvent) => {
            if (e.relatedTarget === null) dropping.value = false;
        };
        const drop = (e: DragEvent) => {
            if (!hasFiles(e)) return;
            e.preventDefault();
            dropping.value = false;
            const file = e.dataTransfer!.files[0];
            if (file) void takeFile(file);
        };
        window.addEventListener("dragover", over);
        window.addEventListener("dragleave", leave);
        window.addEventListener("drop", drop);
        return () => {
            window.removeEventListener("dragover", over);
            window.removeEventListener("dragleave", leave);
            window.removeEventListener("drop", drop);
        };
    }, []);
    // what is being made is watched
    useEffect(() => effect(() => {
        if (!making.value) return;
        page.value = "work";
        dialog.value = null;
        if (mode.peek() === "variants") mode.value = "design";
    }), []);
    return (
        <>
            {page.value === "start" ? <StartPage /> : (
                <div class="workspace">
                    <Bar />
                    <Rail />
                    <main class="middle">
                        <div style={{ position: "relative", display: "grid", minHeight: 0 }}>
                            {mode.value === "variants" ? <VariantsPage /> : <Views />}
                            <Banner />
                            {dropping.value && <div class="dropping">Drop a mesh, an outline, a design or a recipe</div>}
                        </div>
                        <Timeline />
                        <Checks />
                    </main>
                    <Inspector />
                </div>
            )}
            {dialog.value === "open" && <OpenDialog />}
            {dialog.value === "save" && <SaveDialog />}
            {dialog.value === "shortcuts" && <ShortcutsDialog />}
            {dialog.value === "table" && <TableDialog />}
            {dialog.value === "export" && <ExportDialog />}
            {dialog.value === "surface" && <SurfaceDialog />}
            {page.value === "work" && dialog.value === null && <Tour />}
            <div class="hidden-text" role="status" aria-live="polite">{announcement.value || (status.value?.solver === "idle" ? status.value.words : "")}</div>
        </>
    );
}

/** What went wrong, over the views that still show the last good state. */
function Banner() {
    if (making.value)
        return <div class="note banner float" role="status"><i class="ring" /><span class="grow">{progress.value ? `${progress.value.stage || "Solving"}, ${number(100 * progress.value.fraction, 0)} %` : "Solving"}</span><Button small onClick={() => tell("cancel")}>Cancel</Button></div>;
    const p = problem.value;
    const dismiss = <Tool small icon="close" name="Dismiss" onClick={() => (problem.value = null)} />;
    if (closedMessage.value)
        return <div class="note warning banner" role="alert"><Icon name="triangle" /><span class="grow">{closedMessage.value}</span><Button small onClick={() => (page.value = "start")}>Start page</Button></div>;
    if (p && dialog.value === null)
        return <div class="note bad banner" role="alert"><Icon name="crossed" /><span class="grow">{p.error.message}</span>{dismiss}</div>;
    if (connection.value === "open" && report.value?.verdict.severity === "failure" && status.value?.solver === "idle") {
        const finding = report.value.findings.find((f) => f.severity === "failure");
        if (finding && finding.kind === "slack")
            return <div class="note bad banner" role="status"><Icon name="crossed" /><span class="grow">{finding.text}</span><Button small onClick={() => void command("apply", { operator: { op: "tighten" } })}>Tighten to load</Button></div>;
    }
    return null;
}
