import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { CommandError, Link, type TransportEvents } from "../src/protocol/link";
import type { Frame } from "../src/protocol/frames";
import { encodeFrame } from "../src/protocol/frames";

function setUp() {
    const sent: string[] = [];
    const made: TransportEvents[] = [];
    const events: string[] = [];
    const frames: Frame[] = [];
    const link = new Link((e) => (made.push(e), { send: (text) => void sent.push(text), close: () => undefined }), {
        event: (e) => void events.push(e.event), frame: (f) => void frames.push(f), opened: () => void events.push("opened"), lost: () => void events.push("lost"),
    });
    link.start();
    return { sent, made, events, frames, link };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe("the link", () => {
    it("gives every command its own answer, in whatever order they come", async () => {
        const { sent, made, link } = setUp();
        made[0].open();
        const a = link.ask("undo");
        const b = link.ask("redo");
        expect(sent.map((t) => JSON.parse(t))).toEqual([{ do: "undo", id: 1 }, { do: "redo", id: 2 }]);
        made[0].text('{"re":2,"ok":true,"at":5}');
        made[0].text('{"re":1,"ok":false,"error":{"status":2,"word":"usage","message":"Nothing to undo."}}');
        expect((await b).at).toBe(5);
        await expect(a).rejects.toThrow("Nothing to undo.");
        await expect(a).rejects.toBeInstanceOf(CommandError);
    });
    it("fails what waits when it breaks, and comes back later and later", async () => {
        const { made, events, link } = setUp();
        made[0].open();
        const waiting = link.ask("finish");
        made[0].closed();
        await expect(waiting).rejects.toThrow(/stopped/);
        expect(events).toEqual(["opened", "lost"]);
        vi.advanceTimersByTime(249);
        expect(made.length).toBe(1);
        vi.advanceTimersByTime(1);
        expect(made.length).toBe(2);
        made[1].closed();
        vi.advanceTimersByTime(499);
        expect(made.length).toBe(2);
        vi.advanceTimersByTime(1);
        expect(made.length).toBe(3);
        made[2].open();
        expect(events.at(-1)).toBe("opened");
    });
    it("takes a progress event, which has a command's number, as an event", () => {
        const { made, events } = setUp();
        made[0].open();
        made[0].text('{"event":"progress","re":1,"job":"finish","stage":"","fraction":0.5,"residual":null,"done":false}');
        expect(events.at(-1)).toBe("progress");
    });
    it("refuses commands while there is no server, and sends no word", async () => {
        const { sent, link } = setUp();
        await expect(link.ask("undo")).rejects.toThrow(/stopped/);
        link.tell("preview", {});
        expect(sent).toEqual([]);
    });
    it("hands frames on and numbers previews upwards", () => {
        const { made, frames, link } = setUp();
        made[0].open();
        made[0].binary(encodeFrame({ kind: 1, re: 0, topology: 1, revision: 3, serial: 2, flags: 0, sections: new Map() }));
        expect(frames[0].revision).toBe(3);
        expect([link.nextSerial(), link.nextSerial()]).toEqual([1, 2]);
    });
});
