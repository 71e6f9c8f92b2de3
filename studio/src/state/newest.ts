// A mouse may speak a thousand times a second. Of what one pointer event brought only the last word leaves, and no more of them than
// one in so many milliseconds, which is less often than the server may be spoken to.
const every = 8;

export class Newest<T> {
    private next: { value: T } | null = null;
    private sent = -Infinity;
    private timer: ReturnType<typeof setTimeout> | undefined;

    constructor(private readonly send: (value: T) => void) {}

    put(value: T): void {
        const waits = this.next !== null;
        this.next = { value };
        if (waits) return;
        const wait = this.sent + every - performance.now();
        if (wait > 0) this.timer = setTimeout(() => this.leave(), wait);
        else queueMicrotask(() => this.leave()); // when the event has been dealt with
    }

    /** What has not left yet need not leave any more. */
    drop(): void {
        clearTimeout(this.timer);
        this.next = null;
    }

    private leave(): void {
        if (!this.next) return; // dropped
        const { value } = this.next;
        this.next = null;
        this.sent = performance.now();
        this.send(value);
    }
}
