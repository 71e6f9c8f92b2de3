// From state to scene: what the signals say is drawn. The scene itself reads no signal and writes none.
import { effect } from "@preact/signals";
import { connection, currentShell, latency, onShell, revision } from "../state/session";
import { darkTheme, reducedMotion } from "../state/settings";
import { hovered, selected, selectedHinges, shown } from "../state/selection";
import { fieldView, mode, scaleLimit } from "../state/view";
import { motion } from "../state/motion";
import { tool } from "../tools";
import { drawHinges } from "../tools/select";
import { radiusOf } from "./camera";
import { dark, light } from "./look";
import { mark } from "./panelmesh";
import type { Overlay, Stage } from "./stage";
import { Supports } from "./supports";

export function bindScene(stage: Stage): () => void {
    const supports = new Supports();
    const stops: (() => void)[] = [];

    stops.push(onShell((shell, { linkage }) => {
        if (linkage) {
            stage.setShell(shell);
            stage.scenes!.space.scene.add(supports.group);
        } else if (motion.peek().shown === null) stage.setPlaces();
        else stage.invalidate();
    }));
    const known = currentShell();
    if (known) {
        stage.setShell(known);
        stage.scenes!.space.scene.add(supports.group);
    }
    stops.push(effect(() => stage.setLook(darkTheme.value ? dark : light)));
    stops.push(effect(() => void (stage.animated = !reducedMotion.value)));
    stops.push(effect(() => {
        const { shown: k, frames } = motion.value;
        if (k !== null && frames[k]) stage.setPlaces(frames[k]);
        else stage.setPlaces();
    }));
    // colours
    stops.push(effect(() => {
        const view = fieldView.value;
        if (!view || !stage.scenes || view.values.length !== stage.shell?.linkage.panels) return;
        const bars = view.field.id === "force" && stage.shell.forces ? stage.shell.forces.map((f) => f / view.scale.hi) : null;
        stage.each(({ panels }) => {
            panels.setTints(view.tints);
            panels.setForces(bars, view.scale.map.table);
        });
    }));
    // marks: what is beyond the limit, selected, hovered
    stops.push(effect(() => {
        const view = fieldView.value;
        const n = stage.shell?.linkage.panels ?? 0;
        if (!view || !stage.scenes || view.values.length !== n) return;
        const marks = new Uint8Array(n);
        if (view.field.id === "lambda") {
            const limit = scaleLimit.value + 5e-3;
            for (let t = 0; t < n; t++) if (view.values[t] > limit) marks[t] = mark.hatched;
        }
        for (const t of selected.value) if (t < n) marks[t] = mark.selected;
        if (hovered.value >= 0 && hovered.value < n && tool.value.id !== "brush") marks[hovered.value] = mark.hovered;
        stage.each(({ panels }) => panels.setMarks(marks));
    }));
    stops.push(effect(() => {
        const fade = connection.value === "lost" ? 0.6 : 0;
        stage.each(({ panels }) => panels.setFade(fade));
    }));
    stops.push(effect(() => {
        revision.value;
        const shell = currentShell();
        supports.group.visible = mode.value === "analyse" || tool.value.id === "pin";
        if (supports.group.visible && shell && stage.scenes) {
            supports.show(shell, stage.scenes.space.panels.places, stage.scenes.space.panels.edge, radiusOf(stage.scenes.space.bounds), (darkTheme.value ? dark : light).ink);
        }
        stage.invalidate();
    }));
    stops.push(effect(() => {
        const place = shown.value;
        const shell = currentShell();
        if (!place || !shell) return;
        const panel = place.panel >= 0 ? place.panel : place.hinge >= 0 ? shell.linkage.around[2 * place.hinge] : -1;
        if (panel >= 0) stage.lookAt(panel);
    }));

    const toolOverlay: Overlay = (context, s) => {
        drawHinges(context, s, selectedHinges.value);
        tool.peek().overlay?.(context, s);
    };
    stage.overlays.add(toolOverlay);
    stops.push(effect(() => {
        tool.value;
        selectedHinges.value;
        stage.invalidate();
    }));

    stage.onPainted = () => {
        const serial = currentShell()?.serial ?? 0;
        const now = performance.now();
        for (const [sent, at] of latency.sent) {
            if (sent > serial) break;
            if (sent === serial) latency.samples.push(now - at);
            latency.sent.delete(sent);
        }
        if (latency.samples.length > 2000) latency.samples.splice(0, 1000);
    };
    return () => {
        for (const stop of stops) stop();
        stage.overlays.delete(toolOverlay);
        supports.dispose();
    };
}
