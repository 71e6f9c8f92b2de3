import { rail } from "../tools";
import { toolId } from "../tools/tool";
import { layout, type Layout } from "../state/settings";
import { dialog, mode } from "../state/view";
import { Tool } from "./controls";

const order: Layout[] = ["both", "flat", "deployed", "four"];

export function Rail() {
    return (
        <nav class="rail" aria-label="Tools">
            {rail.map((t, k) => t ? (
                <Tool key={t.id} icon={t.icon} name={t.title} shortcut={t.shortcut} pressed={toolId.value === t.id}
                    onClick={() => {
                        toolId.value = t.id;
                        if (mode.value === "variants") mode.value = "design";
                    }} />
            ) : <hr key={k} />)}
            <span class="push" />
            <Tool icon="layout" name="Next layout of views" onClick={() => (layout.value = order[(order.indexOf(layout.value) + 1) % order.length])} />
            <Tool icon="table" name="Panel table" shortcut="T" onClick={() => (dialog.value = "table")} />
        </nav>
    );
}
