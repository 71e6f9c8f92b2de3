import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Newest } from "../src/state/newest";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

it("sends the last of what one event brought, and no more often than the server may be spoken to", () => {
    const sent: [number, number][] = [];
    const newest = new Newest<number>((v) => sent.push([v, performance.now()]));
    for (let k = 0; k < 1000; k++) {
        newest.put(k);
        newest.put(k + 0.5);
        vi.advanceTimersByTime(1);
    }
    vi.advanceTimersByTime(20);
    expect(sent.length).toBeGreaterThan(100);
    expect(sent.length).toBeLessThan(130);
    expect(sent.every(([v]) => v % 1 === 0.5)).toBe(true);
    expect(sent.at(-1)![0]).toBe(999.5);
});

it("forgets what is dropped", () => {
    const send = vi.fn();
    const newest = new Newest<number>(send);
    newest.put(1);
    newest.drop();
    vi.advanceTimersByTime(50);
    expect(send).not.toHaveBeenCalled();
    newest.put(2);
    vi.advanceTimersByTime(50);
    expect(send).toHaveBeenCalledExactlyOnceWith(2);
});
