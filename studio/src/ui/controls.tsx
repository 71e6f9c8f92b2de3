// The controls of which every panel is made.
import type { ButtonHTMLAttributes, CSSProperties, ComponentChildren } from "preact";
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { type LengthUnit, decimals, number, parseQuantity, unitLabel } from "./format";
import { Icon, type IconName } from "./icons";

/** A name and its key appear 500 ms after the pointer or focus arrives. */
function useTip(text: string, key?: string) {
    const [at, setAt] = useState<{ x: number; y: number; left: boolean } | null>(null);
    const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
    const hide = () => {
        clearTimeout(timer.current);
        setAt(null);
    };
    useEffect(() => hide, []);
    const begin = (event: Event) => {
        const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
        clearTimeout(timer.current);
        timer.current = setTimeout(() => setAt(box.left < 60 ? { x: box.right + 8, y: box.top + box.height / 2 - 12, left: true }
            : { x: Math.min(box.left, window.innerWidth - 180), y: box.bottom > window.innerHeight - 60 ? box.top - 32 : box.bottom + 6, left: false }), 500);
    };
    const tip = at && (
        <span class="tip" role="presentation" style={{ left: `${at.x}px`, top: `${at.y}px` }}>
            <span>{text}</span>
            {key && <span>{key}</span>}
        </span>
    );
    return { tip, events: { onPointerEnter: begin, onPointerLeave: hide, onFocus: begin, onBlur: hide, onPointerDown: hide } };
}

export function Tool({ icon, name, shortcut, pressed, small, radio, ...rest }: {
    icon: IconName; name: string; shortcut?: string; pressed?: boolean; small?: boolean; radio?: boolean;
} & Omit<ButtonHTMLAttributes, "icon" | "name">) {
    const { tip, events } = useTip(name, shortcut);
    const state = pressed === undefined ? {} : radio ? { role: "radio" as const, "aria-checked": pressed } : { "aria-pressed": pressed };
    return (
        <button type="button" class={`tool${small ? " small" : ""}`} aria-label={name} aria-keyshortcuts={shortcut} {...state} {...events} {...rest}>
            <Icon name={icon} size={small ? 16 : 20} />
            {tip}
        </button>
    );
}

export function Button({ icon, primary, small, children, ...rest }: {
    icon?: IconName; primary?: boolean; small?: boolean; children: ComponentChildren;
} & ButtonHTMLAttributes) {
    return (
        <button type="button" {...rest} class={`button${primary ? " primary" : ""}${small ? " small" : ""} ${rest.class ?? ""}`}>
            {icon && <Icon name={icon} size={16} />}
            {children}
        </button>
    );
}

export function Segments<T extends string>({ name, value, options, onChange, fill, floating }: {
    name: string; value: T; options: readonly { value: T; title: string; disabled?: boolean }[]; onChange(value: T): void; fill?: boolean; floating?: boolean;
}) {
    const list = useRef<HTMLDivElement>(null);
    const move = (event: KeyboardEvent) => {
        const d = event.key === "ArrowRight" || event.key === "ArrowDown" ? 1 : event.key === "ArrowLeft" || event.key === "ArrowUp" ? -1 : 0;
        if (!d) return;
        event.preventDefault();
        event.stopPropagation();
        const open = options.filter((o) => !o.disabled);
        const next = open[(open.findIndex((o) => o.value === value) + d + open.length) % open.length];
        onChange(next.value);
        requestAnimationFrame(() => list.current?.querySelector<HTMLElement>('[aria-checked="true"]')?.focus());
    };
    const inside = options.some((o) => o.value === value);
    return (
        <div ref={list} class={`segments${fill ? " fill" : ""}${floating ? " floating" : ""}`} role="radiogroup" aria-label={name} onKeyDown={move}>
            {options.map((o, k) => (
                <button key={o.value} type="button" role="radio" aria-checked={o.value === value} disabled={o.disabled}
                    tabIndex={o.value === value || (!inside && k === 0) ? 0 : -1} onClick={() => onChange(o.value)}>
                    {o.title}
                </button>
            ))}
        </div>
    );
}

/** Options of a group stand together, those without one first. */
export interface ChoiceOption<T> {
    value: T;
    title: string;
    disabled?: boolean;
    group?: string;
}

export function Choice<T extends string>({ name, value, options, onChange, icon, bare, id }: {
    name?: string; id?: string; value: T; options: readonly ChoiceOption<T>[]; onChange(value: T): void; icon?: IconName; bare?: boolean;
}) {
    const groups = [...new Set(options.map((o) => o.group))];
    const list = (group?: string) => options.filter((o) => o.group === group).map((o) => <option key={o.value} value={o.value} disabled={o.disabled}>{o.title}</option>);
    return (
        <div class={`choice${bare ? " bare" : ""}`}>
            {icon && <Icon name={icon} size={20} class="icon lead" />}
            <select id={id} aria-label={name} value={value} onChange={(e) => onChange(e.currentTarget.value as T)}>
                {groups.map((g) => (g === undefined ? list() : <optgroup key={g} label={g}>{list(g)}</optgroup>))}
            </select>
            <Icon name="chevron" size={16} />
        </div>
    );
}

export function CheckBox({ value, title, onChange, id }: { value: boolean; title?: string; onChange(value: boolean): void; id?: string }) {
    return (
        <label class="check-box">
            <input id={id} type="checkbox" checked={value} onChange={(e) => onChange(e.currentTarget.checked)} />
            {title && <span>{title}</span>}
        </label>
    );
}

export interface NumberProps {
    value: number | null;
    unit?: string;
    documentUnit: LengthUnit;
    lo?: number | null;
    hi?: number | null;
    integer?: boolean;
    placeholder?: string;
    onChange(value: number): void;
    onClear?(): void;
    id?: string;
    name?: string;
    step?: number;
    /** Stands where the unit does. */
    mark?: string;
}

/** Arrows step by the last shown digit, ten times with Shift, a tenth with Alt; Enter takes it, Escape gives it back. */
export function NumberField({ value, unit = "", documentUnit, lo = null, hi = null, integer, placeholder, onChange, onClear, id, name, step, mark }: NumberProps) {
    const digits = value === null || integer ? 0 : unit === "deg" || unit === "%" ? (Math.abs(value) >= 10 ? 0 : 1) : Math.max(2, decimals(value, 2));
    const shown = value === null ? "" : integer ? String(Math.round(value)) : number(value, Math.min(digits, 6)).replaceAll(",", "");
    const [text, setText] = useState<string | null>(null);
    const [wrong, setWrong] = useState("");
    const message = useId();
    const label = mark ?? unitLabel(unit, documentUnit);
    const plain = (v: number) => String(Number(v.toPrecision(4)));
    const range = () => lo !== null && hi !== null ? `Between ${plain(lo)} and ${plain(hi)}` : lo !== null ? `At least ${plain(lo)}` : hi !== null ? `At most ${plain(hi)}` : "A number";
    const take = (source: string) => {
        setText(null);
        if (source.trim() === "" && onClear) {
            setWrong("");
            onClear();
            return;
        }
        const v = parseQuantity(source, unit, documentUnit);
        if (v === null || (lo !== null && v < lo) || (hi !== null && v > hi)) {
            setWrong(v === null ? "Not a number here" : range());
            setText(source);
            return;
        }
        setWrong("");
        if (source !== shown) onChange(integer ? Math.round(v) : v);
    };
    const nudge = (event: KeyboardEvent) => {
        if (event.key === "Enter") take((event.currentTarget as HTMLInputElement).value);
        else if (event.key === "Escape") {
            setText(null);
            setWrong("");
            event.stopPropagation();
        } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
            event.preventDefault();
            const unitStep = step ?? (integer ? 1 : 10 ** -Math.min(digits, 2));
            const size = unitStep * (event.shiftKey ? 10 : event.altKey && !integer ? 0.1 : 1);
            const next = (value ?? 0) + (event.key === "ArrowUp" ? size : -size);
            setText(null);
            onChange(Math.max(lo ?? -Infinity, Math.min(hi ?? Infinity, Number(next.toPrecision(12)))));
        }
    };
    return (
        <div>
            <div class={`field${wrong ? " wrong" : ""}`}>
                <input id={id} aria-label={name} type="text" inputMode="decimal" autocomplete="off" spellcheck={false} value={text ?? shown} placeholder={placeholder}
                    aria-invalid={wrong !== ""} aria-describedby={wrong ? message : undefined} onInput={(e) => setText(e.currentTarget.value)}
                    onFocus={(e) => e.currentTarget.select()} onBlur={(e) => text !== null && take(e.currentTarget.value)} onKeyDown={nudge} />
                {label && <span class="unit" aria-hidden="true">{label}</span>}
            </div>
            {wrong && <div id={message} class="problem" role="alert">{wrong}</div>}
        </div>
    );
}

export function Slider({ value, lo, hi, step, name, onChange, onCommit, text }: {
    value: number; lo: number; hi: number; step: number; name: string; onChange(value: number): void; onCommit?(value: number): void; text?: string;
}) {
    return (
        <input type="range" class="slider" aria-label={name} aria-valuetext={text} min={lo} max={hi} step={step} value={value}
            style={{ "--share": `${(100 * (value - lo)) / (hi - lo || 1)}%` } as unknown as CSSProperties}
            onInput={(e) => onChange(Number(e.currentTarget.value))} onChange={(e) => onCommit?.(Number(e.currentTarget.value))} />
    );
}

/** A label with a slider and a number, a number alone, or whatever else is given. */
/** `short`: the label takes no more room than it needs. */
export function Row({ label, children, title, short }: { label: string; title?: string; short?: boolean; children: (id: string) => ComponentChildren }) {
    const id = useId();
    return (
        <div class={`form-row${short ? " short" : ""}`}>
            <label class="label" for={id} title={title ?? label}>{label}</label>
            <div>{children(id)}</div>
        </div>
    );
}

export function NumberRow(props: NumberProps & { label: string; title?: string; slider?: [number, number] }) {
    const { label, title, slider, ...rest } = props;
    return (
        <Row label={label} title={title}>
            {(id) => slider ? (
                <div class="with-slider">
                    <Slider value={Math.max(slider[0], Math.min(slider[1], rest.value ?? slider[0]))} lo={slider[0]} hi={slider[1]}
                        step={rest.integer ? 1 : (slider[1] - slider[0]) / 200} name={label} onChange={rest.onChange} />
                    <NumberField {...rest} id={id} />
                </div>
            ) : <NumberField {...rest} id={id} />}
        </Row>
    );
}

export function Section({ title, aside, children, id }: { title: string; aside?: ComponentChildren; children?: ComponentChildren; id?: string }) {
    return (
        <section class="section" aria-label={title} id={id}>
            <header>
                <h2>{title}</h2>
                {aside !== undefined && <span class="aside">{aside}</span>}
            </header>
            {children}
        </section>
    );
}

const focusable = 'button:not(:disabled):not([tabindex="-1"]), input, select, textarea, a[href], [tabindex="0"]';

export function Dialog({ title, size = "", onClose, children, footer }: {
    title: string; size?: "" | "wide" | "middle-size"; onClose(): void; children: ComponentChildren; footer?: ComponentChildren;
}) {
    const box = useRef<HTMLDivElement>(null);
    const heading = useId();
    useEffect(() => {
        const before = document.activeElement as HTMLElement | null;
        box.current?.focus();
        return () => before?.focus();
    }, []);
    const keys = (event: KeyboardEvent) => {
        event.stopPropagation();
        if (event.key === "Escape") onClose();
        if (event.key !== "Tab") return;
        const all = [...box.current!.querySelectorAll<HTMLElement>(focusable)].filter((e) => e.offsetParent !== null);
        const edge = event.shiftKey ? all[0] : all.at(-1);
        if (document.activeElement === edge || document.activeElement === box.current) {
            event.preventDefault();
            (event.shiftKey ? all.at(-1) : all[0])?.focus();
        }
    };
    return (
        <div class="veil" onPointerDown={(e) => e.target === e.currentTarget && onClose()}>
            <div ref={box} class={`dialog ${size}`} role="dialog" aria-modal="true" aria-labelledby={heading} tabIndex={-1} onKeyDown={keys}>
                <div class="dialog-head">
                    <h2 id={heading}>{title}</h2>
                    <Tool icon="close" name="Close" onClick={onClose} />
                </div>
                {children}
                {footer && <div class="dialog-foot">{footer}</div>}
            </div>
        </div>
    );
}

export const severityIcon: Record<string, IconName> = { pass: "tick", note: "tick", warning: "triangle", failure: "crossed", unknown: "unknown" };
export const severityClass: Record<string, string> = { pass: "good", note: "good", warning: "warning", failure: "bad", unknown: "muted" };
