// The way from the hand to the screen, each part apart. Times are milliseconds of performance.now().

export interface Sample {
    /** Of the newest pointer event in the preview, as the browser stamped it. */
    moved: number;
    /** The preview left. */
    sent: number;
    /** The first state that holds it came in, */
    arrived: number;
    /** began to be drawn, */
    began: number;
    /** was with the browser or the graphics card, */
    submitted: number;
    /** and done. */
    drawn: number;
}

const most = 2000;
const under: Map<number, Partial<Sample>> = new Map();
let hand = 0;

/** What was measured, for whoever reads it from outside; empty it before a measurement. */
export const samples: Sample[] = [];

/** Movements that are not on screen yet. */
export const pending = () => under.size;

/** A pointer moved, at the event's time stamp. */
export function handMoved(at: number): void {
    hand = at;
}

export function previewLeft(serial: number): void {
    const sent = performance.now();
    under.set(serial, { moved: Math.min(hand, sent), sent });
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

export const stateArrived = (serial: number) => reached(serial, { arrived: performance.now() });
export const stateSubmitted = (serial: number, began: number) => reached(serial, { began, submitted: performance.now() });
export const stateDrawn = (serial: number) => reached(serial, { drawn: performance.now() });
