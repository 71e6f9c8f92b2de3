// Constraints on what is selected: pressing the tool on the shell selects like the select tool does; its panel adds constraints.
import { signal } from "@preact/signals";
import { operators } from "../state/session";
import { selectTool } from "./select";
import type { Tool } from "./tool";

export const constraintOp = signal("");
export const constraintOperators = () => operators.value.filter((o) => o.group === "constraint");

export const pin: Tool = { ...selectTool, id: "pin", title: "Constrain", icon: "pin", shortcut: "P" };
