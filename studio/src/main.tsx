import { render } from "preact";
import "./styles/tokens.css";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/layout.css";
import { socketTo } from "./protocol/link";
import * as latency from "./state/latency";
import { motion } from "./state/motion";
import * as selection from "./state/selection";
import * as session from "./state/session";
import { connect, currentShell } from "./state/session";
import { stage } from "./state/view";
import { App } from "./ui/app";
import { listenToKeys } from "./ui/keyboard";

async function begin(): Promise<void> {
    listenToKeys();
    render(<App />, document.getElementById("app")!);
    const fixture = import.meta.env.DEV ? new URLSearchParams(location.search).get("fixture") : null;
    if (import.meta.env.DEV && fixture) {
        const { fixtureTransport } = await import("../dev/fixture");
        connect(fixtureTransport(fixture));
    } else connect(socketTo(location));
}

/** For measuring from outside: the way from hand to screen, and what is shown. */
Object.assign(window, { auxshell: { latency, stage, session, selection, motion, shell: currentShell } });
void begin();
