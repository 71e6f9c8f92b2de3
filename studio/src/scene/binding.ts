// From state to scene: what the signals say is drawn. The scene itself reads no signal and writes none.
import { effect } from "@preact/signals";
import { stamped, stateDrawn, stateSubmitted } from "../state/latency";
import { acknowledge, connection, currentShell, frames, handAsks, holdStates, making, onShell, settleFrames, watchStates } from "../state/session";
import { darkTheme, reducedMotion } from "../state/settings";
import { hovered, selected, selectedHinges, shown } from "../state/selection";
import { fieldView, mode, scaleLimit, tints } from "../state/view";
import { motion } from "../state/motion";
import { tool } from "../tools";
import { activePoint, rimHandles } from "../tools/rim";
import { drawHinges, drawPanel } from "../tools/select";
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
    stops.push(effect(() => stage.follows(making.value)));
    stops.push(effect(() => {
        const { shown: k, frames: states } = motion.value;
        if (k !== null && states[k]) stage.setPlaces(states[k]);
        else stage.setPlaces();
    }));
    // forces and colours
    stops.push(effect(() => {
        const view = fieldView.value;
        if (!view || !stage.scenes || view.values.length !== stage.shell?.linkage.panels) return;
        const bars = view.field.id === "force" && stage.shell.forces ? stage.shell.forces.map((f) => f / view.scale.hi) : null;
        const { map, lo, hi } = view.scale;
        stage.colouring = { field: view.field.id, map: map.name, lo, hi };
        stage.each(({ panels }) => {
            panels.setForces(bars, map.table);
        });
    }));
    stops.push(effect(() => {
        const colours = tints.value;
        if (colours && stage.scenes && colours.length === 4 * stage.shell!.linkage.panels) stage.each(({ panels }) => panels.setTints(colours));
    }));
    // marks: what is beyond the limit, selected
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
        stage.each(({ panels }) => panels.setMarks(marks));
    }));
    stops.push(effect(() => {
        const fade = connection.value === "lost" ? 0.6 : 0;
        stage.each(({ panels }) => panels.setFade(fade));
    }));
    stops.push(effect(() => {
        frames.value;
        const shell = currentShell();
        const visible = mode.value === "analyse" || tool.value.id === "pin";
        if (visible || supports.group.visible) stage.invalidateBackdrop();
        supports.group.visible = visible;
        if (visible && shell && stage.scenes)
            supports.show(shell, stage.scenes.space.panels.places, stage.scenes.space.panels.edge, radiusOf(stage.scenes.space.bounds), (darkTheme.value ? dark : light).ink);
    }));
    stops.push(effect(() => {
        const place = shown.value;
        const n = currentShell()?.linkage.panels ?? 0;
        if (place && place.panels.every((t) => t < n)) stage.lookAt(place.panels);
    }));

    const toolOverlay: Overlay = (context, s) => {
        if (tool.peek().id !== "brush") drawPanel(context, s, hovered.peek());
        drawHinges(context, s, selectedHinges.peek());
        tool.peek().overlay?.(context, s);
    };
    stage.overlays.add(toolOverlay);
    stops.push(effect(() => {
        tool.value;
        hovered.value;
        selectedHinges.value;
        stage.invalidateOverlay();
    }));

    stops.push(effect(() => {
        if (tool.value.id === "rim") rimHandles();
        activePoint.value;
        stage.invalidateOverlay();
    }));
    stops.push(effect(() => {
        if (handAsks.value) stage.expect();
    }));

    stops.push(holdStates(() => stage.rendering));
    stage.onBefore = settleFrames;
    stage.watch = watchStates;
    stage.onStamped = stamped;
    stage.onSubmitted = (began) => {
        if (stage.isLive) return acknowledge; // what the worker drew is stamped there
        const serial = currentShell()?.serial ?? 0;
        stateSubmitted(serial, began);
        return () => {
            stateDrawn(serial);
            acknowledge();
        };
    };
    return () => {
        for (const stop of stops) stop();
        stage.overlays.delete(toolOverlay);
        supports.dispose();
    };
}
