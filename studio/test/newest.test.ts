import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Newest } from "../src/state/newest";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

it("sends the last of what one event brought, and no more often than the server may be spoken to", async () => {
    const sent: [number, number][] = [];
    const newest = new Newest<number>((v) => sent.push([v, performance.now()]));
    for (let k = 0; k < 1000; k++) {
        newest.put(k);
        newest.put(k + 0.5);
        await Promise.resolve();
        vi.advanceTimersByTime(1);
    }
    vi.advanceTimersByTime(20);
    expect(sent.length).toBeGreaterThan(100);
    expect(sent.length).toBeLessThan(130);
    expect(sent.every(([v]) => v % 1 === 0.5)).toBe(true);
    expect(sent.at(-1)![0]).toBe(999.5);
});

it("does not wait for a timer when nothing was said for a while", async () => {
    const send = vi.fn();
    new Newest<number>(send).put(1);
    await Promise.resolve();
    expect(send).toHaveBeenCalledExactlyOnceWith(1);
});

it("forgets what is dropped", async () => {
    const send = vi.fn();
    const newest = new Newest<number>(send);
    newest.put(1);
    newest.drop();
    await Promise.resolve();
    vi.advanceTimersByTime(50);
    expect(send).not.toHaveBeenCalled();
    newest.put(2);
    await Promise.resolve();
    vi.advanceTimersByTime(50);
    expect(send).toHaveBeenCalledExactlyOnceWith(2);
});
