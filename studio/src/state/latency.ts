// The way from the hand to the screen, each part apart. Times are milliseconds of performance.now().
import { type Frame, section } from "../protocol/frames";

export interface Sample {
    /** Of the newest pointer event in the preview, as the browser stamped it. */
    moved: number;
    /** The page was told of it. */
    heard: number;
    /** The preview left. */
    sent: number;
    /** The first state that holds it came in, */
    arrived: number;
    /** came to who draws it, */
    came: number;
    /** Until the server began on it, and from then until its state was there: milliseconds. */
    waited: number;
    solved: number;
    /** began to be drawn, */
    began: number;
    /** was with the browser or the graphics card, */
    submitted: number;
    /** by the worker, apart from the page, */
    apart?: boolean;
    /** and done. */
    drawn: number;
}

const most = 2000;
const under: Map<number, Partial<Sample>> = new Map();
let hand = { moved: 0, heard: 0 };

/** What was measured, for whoever reads it from outside; empty it before a measurement. */
export const samples: Sample[] = [];

/** Movements that are not on screen yet. */
export const pending = () => under.size;

/** A pointer moved, at the event's time stamp. */
export function handMoved(at: number): void {
    hand = { moved: at, heard: performance.now() };
}

export function previewLeft(serial: number): void {
    const sent = performance.now();
    under.set(serial, { moved: Math.min(hand.moved, sent), heard: hand.heard, sent });
}

/** What was not on screen by then never will be. */
export function gestureEnded(): void {
    under.clear();
}

/** What held this preview or a later one got so far. */
function reached(serial: number, parts: Partial<Sample>): void {
    for (const [key, sample] of under) {
        if (key > serial) break;
        under.set(key, { ...parts, ...sample });
        if (parts.drawn === undefined || sample.submitted === undefined) continue;
        samples.push(under.get(key) as Sample);
        under.delete(key);
    }
    if (samples.length > most) samples.splice(0, most / 2);
}

const arrival = (frame: Frame): Stamp => [frame.serial, { arrived: performance.now(), came: performance.now(), ...serverTimes(frame) }];
export const stateArrived = (frame: Frame) => reached(...arrival(frame));

let gathered: Stamp | null = null;
/** It counts where the page draws it. */
export function statesGathered(frame: Frame): void {
    gathered = arrival(frame);
}

/** What the server says of how it came to a state. */
export function serverTimes(frame: Frame): Partial<Sample> {
    const times = frame.sections.get(section.times);
    return times ? { waited: times[0], solved: times[1] } : {};
}

export function stateSubmitted(serial: number, began: number): void {
    if (gathered) reached(...gathered);
    gathered = null;
    reached(serial, { began, submitted: performance.now() });
}
export const stateDrawn = (serial: number) => reached(serial, { drawn: performance.now() });

/** What happened to states apart from the page, in its order. */
export type Stamp = [serial: number, at: Partial<Sample>];
export function stamped(stamps: Stamp[]): void {
    for (const [serial, at] of stamps) reached(serial, at);
}
