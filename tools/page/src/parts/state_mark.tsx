// States as a shape, a word and a colour, so that none depends on colour alone.

export type Mark = 'good' | 'warn' | 'bad' | 'idle';

export interface Condition {
    mark: Mark;
    word: string;
}

const kShapes = {
    good: <circle cx="6" cy="6" r="5" />,
    warn: <path d="M6 .8 11.6 11H.4Z" />,
    bad: <path d="M2.2.6 6 4.4 9.8.6l1.6 1.6L7.6 6l3.8 3.8-1.6 1.6L6 7.6l-3.8 3.8L.6 9.8 4.4 6 .6 2.2Z" />,
    idle: <path d="M1.2 1.2h9.6v9.6H1.2Z" />,
};

export function Shape({ mark }: { mark: Mark }) {
    return (
        <svg class={`shape ${mark}`} viewBox="0 0 12 12" aria-hidden="true">
            {kShapes[mark]}
        </svg>
    );
}

export function StateMark({ mark, word }: Condition) {
    return (
        <span class={`state ${mark}`}>
            <Shape mark={mark} />
            {word}
        </span>
    );
}
