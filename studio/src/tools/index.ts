import { computed } from "@preact/signals";
import { brush } from "./brush";
import { dynamics } from "./dynamics";
import { measure } from "./measure";
import { fill, gradient, pipette, smooth } from "./paintbox";
import { pin } from "./pin";
import { rim } from "./rim";
import { selectTool } from "./select";
import { type Tool, toolId } from "./tool";

/** As they stand in the rail; null: a line between groups. */
export const rail: (Tool | null)[] = [selectTool, null, brush, fill, gradient, smooth, pipette, null, rim, pin, dynamics, null, measure];
export const tools = rail.filter((t): t is Tool => t !== null);
export const tool = computed(() => tools.find((t) => t.id === toolId.value) ?? selectTool);
