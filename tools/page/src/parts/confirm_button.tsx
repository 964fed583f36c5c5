// A button whose action ends or interrupts something. A second click within 6 s confirms it.

import { useEffect, useRef, useState } from 'preact/hooks';
import type { ComponentChildren } from 'preact';

interface Props {
    children: ComponentChildren;
    question: string;
    onConfirm(): void;
    disabled?: boolean;
}

const kQuestionMs = 6000;

export function ConfirmButton({ children, question, onConfirm, disabled }: Props) {
    const [isAsking, setAsking] = useState(false);
    const button = useRef<HTMLButtonElement>(null);
    useEffect(() => {
        if (!isAsking) return;
        const timer = setTimeout(() => setAsking(false), kQuestionMs);
        return () => clearTimeout(timer);
    }, [isAsking]);
    const click = () => {
        if (isAsking) onConfirm();
        setAsking(!isAsking);
    };
    return (
        <button ref={button} class={isAsking ? 'danger' : ''} disabled={disabled} onClick={click} aria-live="polite"
            onKeyDown={event => {
                if (event.key !== 'Escape' || !isAsking) return;
                event.stopPropagation();
                setAsking(false);
            }}>
            {isAsking ? question : children}
        </button>
    );
}
