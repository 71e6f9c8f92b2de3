// The inspector: settings of the tool first, then constraints, recipe, variants; the last line names what is under the cursor.
import { currentShell, documentState, readOnly } from "../state/session";
import { hovered, hoveredHinge, selected, selectedHinges } from "../state/selection";
import { fieldView, drawerOpen, mode } from "../state/view";
import { revision } from "../state/session";
import { AnalysePanel } from "./analyse";
import { Tool } from "./controls";
import { type LengthUnit, number, plural, unitLabel } from "./format";
import { Constraints } from "./constraints";
import { Recipe } from "./recipe";
import { ToolPanel } from "./toolpanel";
import { Variants } from "./variants";
import { drawer } from "../state/settings";

export function Inspector() {
    return (
        <aside class={`inspector${drawerOpen.value ? " open" : ""}`} aria-label="Inspector">
            <div class="sections" tabIndex={0} role="group" aria-label="Settings">
                {drawer.value && <div style={{ float: "right", padding: "2px" }}><Tool icon="close" name="Close the inspector" small onClick={() => (drawerOpen.value = false)} /></div>}
                {mode.value === "analyse" ? <AnalysePanel /> : (
                    <>
                        {readOnly.value === null && <ToolPanel />}
                        <Constraints />
                        <Recipe />
                        <Variants />
                    </>
                )}
            </div>
            <StatusLine />
        </aside>
    );
}

function StatusLine() {
    revision.value;
    const shell = currentShell();
    const view = fieldView.value;
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    const t = hovered.value;
    if (shell && view && t >= 0 && t < view.values.length)
        return (
            <div class="status-line">
                <span>Panel {shell.name(t)}, hinge {hoveredHinge.value}</span>
                <span>{view.field.id === "lambda" ? "λ " : ""}{number(view.values[t], view.field.digits)} {unitLabel(view.field.unit, unit)}</span>
            </div>
        );
    const words = selectedHinges.value.length ? `${plural(selectedHinges.value.length, "hinge")} selected` : selected.value.size === 1 && shell ? `Panel ${shell.name([...selected.value][0])} selected` : selected.value.size ? `${plural(selected.value.size, "panel")} selected` : "";
    return <div class="status-line"><span>{words}</span></div>;
}
