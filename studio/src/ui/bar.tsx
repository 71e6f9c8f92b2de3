import { useSignal } from "@preact/signals";
import { commandNamed, finish } from "../state/commands";
import { connection, documentState, making, progress, readOnly, reconnect, report, status } from "../state/session";
import { darkTheme, theme } from "../state/settings";
import { cancelRecording, recording } from "../state/video";
import { type Mode, dialog, drawerOpen, mode, page } from "../state/view";
import { Button, Segments, Tool } from "./controls";
import { number, time } from "./format";
import { Icon, Mark } from "./icons";

export function SolverChip() {
    const s = status.value;
    const p = progress.value;
    if (connection.value === "lost")
        return (
            <span class="row" role="status">
                <span class="chip bad"><Icon name="unlinked" size={16} /><span>Server stopped. Work is saved</span></span>
                <Button small onClick={reconnect}>Reconnect</Button>
            </span>
        );
    if (p)
        return (
            <span class="row" role="status">
                <span class="chip plain"><i class="ring" /><span>{p.stage || p.job}{p.fraction > 0 ? `, ${number(100 * p.fraction, 0)} %` : ""}</span></span>
                {!making.value && <Button small onClick={commandNamed("cancel").run}>Cancel</Button>}
            </span>
        );
    if (recording.value)
        return (
            <span class="row">
                <span class="chip plain"><i class="ring" /><span>Recording, {number(100 * recording.value.share, 0)} %</span></span>
                <Button small onClick={cancelRecording}>Cancel</Button>
            </span>
        );
    if (!s) return null;
    if (s.solver !== "idle") return <span class="chip plain" role="status"><i class="ring" /><span>{s.words}</span></span>;
    const failures = report.value?.checks.filter((c) => c.severity === "failure") ?? [];
    const severity = report.value?.verdict.severity;
    const tone = failures.length ? "bad" : s.state === "edited" || s.state === "unsettled" ? "plain" : severity === "warning" && s.state !== "exact" ? "warning" : "good";
    const icon = { bad: "crossed", plain: "triangle", warning: "triangle", good: "tick" }[tone];
    return (
        <span class={`chip ${tone}`} role="status">
            <Icon name={icon} size={16} />
            <span>{failures.length ? `Cannot deploy: ${failures[0].answer}` : s.words}</span>
        </span>
    );
}

function Saved() {
    const d = documentState.value;
    if (!d) return null;
    const text = readOnly.value ? `Read-only: ${readOnly.value}` : d.path ? "Saved" : d.autosaved ? `Draft, kept ${time(d.autosaved).replace("Today, ", "")}` : "Draft";
    return <span class="saved" title={d.path ?? "Not saved under a name yet"}>{text}</span>;
}

export function ThemeButton() {
    return <Tool icon={darkTheme.value ? "sun" : "moon"} name={darkTheme.value ? "Light" : "Dark"} shortcut="Ctrl+Alt+T" onClick={() => (theme.value = darkTheme.value ? "light" : "dark")} />;
}

export function Bar() {
    const d = documentState.value;
    const undo = commandNamed("undo");
    const redo = commandNamed("redo");
    const exact = status.value?.state === "exact";
    const busy = useSignal(false);
    return (
        <header class="bar">
            <div class="start">
                <button type="button" class="home" aria-label="Start page" onClick={() => (page.value = "start")}><Mark /></button>
                <h1 class="name ellipsis" style={{ font: "600 13px/20px var(--font)", letterSpacing: 0 }}>{d?.name ?? "Auxshell Studio"}</h1>
                <Saved />
                <Tool icon="undo" name={d?.undo ? `Undo ${d.undo}` : "Undo"} shortcut="Ctrl+Z" disabled={!undo.when!()} onClick={undo.run} />
                <Tool icon="redo" name={d?.redo ? `Redo ${d.redo}` : "Redo"} shortcut="Ctrl+Shift+Z" disabled={!redo.when!()} onClick={redo.run} />
            </div>
            <Segments<Mode> name="Work on" value={mode.value} options={[{ value: "design", title: "Design" }, { value: "analyse", title: "Analyse" }, { value: "variants", title: "Variants" }]} onChange={(m) => (mode.value = m)} />
            <div class="end">
                <SolverChip />
                <ThemeButton />
                <Tool icon="help" name="Keyboard shortcuts" shortcut="?" onClick={() => (dialog.value = "shortcuts")} />
                <Tool icon="more" name="Inspector" class="tool drawer-button" shortcut="Alt+I" onClick={() => (drawerOpen.value = !drawerOpen.value)} />
                <Button class="finish" disabled={!d || readOnly.value !== null || progress.value !== null || exact || busy.value}
                    onClick={() => {
                        busy.value = true;
                        void finish().finally(() => (busy.value = false));
                    }}>Finish</Button>
                <Button primary icon="export" disabled={!d} aria-label="Export" onClick={() => (dialog.value = "export")}><span class="words">Export</span></Button>
            </div>
        </header>
    );
}
