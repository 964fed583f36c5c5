// The condition of a node and of an output in one word. Pure.

import type { Condition } from '../parts/state_mark.tsx';
import type { NodeStatus, Output, Status } from '../wire/types.ts';
import type { Rates } from './history.ts';

// Silence of a node, or age of an output's picture, from which it counts as a fault in s.
const kSilentSeconds = 3;
// A node is slow if its frames take this many times the median of the others, and at least this long.
const kSlowRatio = 1.6;
const kSlowMs = 4;

export function isSlow(node: number, rates: Rates | null): boolean {
    const mine = rates?.nodes.get(node)?.replayMs ?? NaN;
    if (!rates || !(mine >= kSlowMs)) return false;
    const others = [...rates.nodes].filter(([other, rate]) => other !== node && rate.replayMs > 0).map(([, rate]) => rate.replayMs);
    others.sort((a, b) => a - b);
    return others.length > 0 && mine > kSlowRatio * others[others.length >> 1]!;
}

export function conditionOf(node: NodeStatus, rates: Rates | null): Condition {
    if (node.state === 'lost') return { mark: 'bad', word: 'lost' };
    if (node.state === 'rejoining') return { mark: 'warn', word: 'rejoining' };
    if (node.state === 'stopped') return { mark: 'idle', word: 'stopped' };
    if (node.state !== 'alive') return { mark: 'warn', word: String(node.state) };
    if (node.silentSeconds > kSilentSeconds) return { mark: 'warn', word: 'silent' };
    if (isSlow(node.node, rates)) return { mark: 'warn', word: 'slow' };
    return { mark: 'good', word: 'alive' };
}

// Returns the condition of an output from its proof of life; null without such a proof.
export function outputCondition(output: Output | undefined, addedSeconds: number): Condition | null {
    if (!output) return null;
    return output.ageSeconds + addedSeconds > kSilentSeconds ? { mark: 'bad', word: 'frozen' } : { mark: 'good', word: 'live' };
}

// Returns one line about the whole session.
export function headline(status: Status, rates: Rates | null): Condition {
    const lost = status.nodes.filter(node => node.state === 'lost').map(node => node.node);
    if (lost.length) return { mark: 'bad', word: `node ${lost.join(', ')} lost` };
    const joining = status.nodes.filter(node => node.state === 'rejoining').map(node => node.node);
    if (joining.length) return { mark: 'warn', word: `node ${joining.join(', ')} rejoining` };
    const slow = status.nodes.filter(node => conditionOf(node, rates).word === 'slow').map(node => node.node);
    if (slow.length) return { mark: 'warn', word: `node ${slow.join(', ')} slow` };
    const silent = status.nodes.filter(node => conditionOf(node, rates).word === 'silent').map(node => node.node);
    if (silent.length) return { mark: 'warn', word: `node ${silent.join(', ')} silent` };
    if (!status.programs.length) return { mark: 'idle', word: 'no program' };
    return { mark: 'good', word: 'all nodes alive' };
}
