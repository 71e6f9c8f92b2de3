// The first-run tour: five steps, each beside what it speaks of.
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { tourSeen } from "../state/settings";
import { tourStep } from "../state/view";
import { Button } from "./controls";

const steps: { at: string; title: string; text: string }[] = [
    { at: ".views", title: "One shell, two states", text: "Left as it is cut and lies flat, right as it stands. Hover a panel: it lights up in both. Turn with the right button, zoom with the wheel." },
    { at: '.rail [aria-keyshortcuts="B"]', title: "Paint how far it opens", text: "Press B and drag on either view. A higher scale factor λ makes the shell bulge there. F changes the radius." },
    { at: ".checks", title: "Can it deploy?", text: "Always answered here. Click a check to go to the place it speaks of." },
    { at: "#recipe", title: "The recipe is the history", text: "Click a step to go back, change its numbers, and what follows is played again." },
    { at: ".bar .end", title: "Finish, then export", text: "Finish solves both states exactly. Export writes files to cut, to build and to go on with." },
];

export function Tour() {
    const k = tourStep.value;
    const [box, setBox] = useState<DOMRect | null>(null);
    const card = useRef<HTMLDivElement>(null);
    useLayoutEffect(() => {
        const measure = () => setBox(k >= 0 && k < steps.length ? (document.querySelector(steps[k].at)?.getBoundingClientRect() ?? null) : null);
        measure();
        window.addEventListener("resize", measure);
        return () => window.removeEventListener("resize", measure);
    }, [k]);
    useEffect(() => {
        if (k >= 0) card.current?.focus();
    }, [k]);
    if (k < 0 || k >= steps.length) return null;
    const end = () => {
        tourStep.value = -1;
        tourSeen.value = true;
    };
    const step = steps[k];
    const b = box ?? new DOMRect(innerWidth / 2, innerHeight / 2, 0, 0);
    const right = b.right + 340 < innerWidth;
    const place = b.width > innerWidth / 2
        ? { left: `${b.left + b.width / 2 - 160}px`, top: `${b.height > 300 ? b.top + 64 : b.top - 172}px` }
        : right ? { left: `${b.right + 12}px`, top: `${Math.max(12, Math.min(b.top, innerHeight - 200))}px` }
            : { left: `${Math.max(12, b.top < 60 ? innerWidth - 340 : b.left - 336)}px`, top: `${Math.max(60, Math.min(b.top < 60 ? b.bottom + 12 : b.top, innerHeight - 200))}px` };
    return (
        <>
            <div class="tour-target" style={{ left: `${b.left + 2}px`, top: `${b.top + 2}px`, width: `${Math.max(0, b.width - 4)}px`, height: `${Math.max(0, b.height - 4)}px` }} />
            <div class="tour" ref={card} role="dialog" aria-label={`Tour: ${step.title}`} tabIndex={-1} style={place} onKeyDown={(e) => {
                e.stopPropagation();
                if (e.key === "Escape") end();
            }}>
                <h2>{step.title}</h2>
                <p class="muted">{step.text}</p>
                <footer>
                    <span class="small faint grow">{k + 1} of {steps.length}</span>
                    <Button small onClick={end}>{k === steps.length - 1 ? "Close" : "Skip"}</Button>
                    {k > 0 && <Button small onClick={() => (tourStep.value = k - 1)}>Back</Button>}
                    {k < steps.length - 1 && <Button small primary onClick={() => (tourStep.value = k + 1)}>Next</Button>}
                </footer>
            </div>
        </>
    );
}
