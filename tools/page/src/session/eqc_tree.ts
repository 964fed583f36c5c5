// The blocks of a configuration file as a tree, for reading. Pure. The head parses the file itself.

export interface EqcNode {
    name: string;
    // Values after the name: words and texts up to the next name.
    values: string[];
    children: EqcNode[];
}

// Deeper blocks appear within their ancestors of this depth.
const kMostDepth = 24;
const kToken = /#[^\n]*|"(?:[^"\\]|\\.)*"|[{}[\]()]|[^\s{}[\]()"#]+/g;

function isName(token: string): boolean {
    return /^[A-Za-z_]\w*$/.test(token);
}

// Values are quoted texts, numbers, and words in capitals; other words begin an entry.
function isValue(token: string): boolean {
    return token.startsWith('"') || !isName(token) || /^[A-Z][A-Z0-9_]*$/.test(token);
}

export function parseEqc(text: string): EqcNode[] {
    const tokens = (text.match(kToken) ?? []).filter(token => !token.startsWith('#'));
    let at = 0;
    const entries = (depth: number): EqcNode[] => {
        const list: EqcNode[] = [];
        while (at < tokens.length && tokens[at] !== '}') {
            const token = tokens[at++]!;
            if (token === '{') {
                const last = list[list.length - 1];
                const children = depth < kMostDepth ? entries(depth + 1) : [];
                if (last) last.children.push(...children);
                if (tokens[at] === '}') ++at;
            } else if (token === '[' || token === '(') {
                const inner: string[] = [];
                while (at < tokens.length && tokens[at] !== ']' && tokens[at] !== ')') inner.push(tokens[at++]!);
                const close = tokens[at++] ?? '';
                list[list.length - 1]?.values.push(`${token} ${inner.join(' ')} ${close}`);
            } else if (list.length && isValue(token)) list[list.length - 1]!.values.push(token);
            else list.push({ name: token, values: [], children: [] });
        }
        return list;
    };
    const list = entries(0);
    return list;
}
