// The condition of a node and of an output in one word, and its reason in one line. Pure.

import type { Condition } from '../parts/state_mark.tsx';
import { duration, ms } from '../parts/format.ts';
import type { HeadEvent, LogLine, NodeStatus, Output, Status } from '../wire/types.ts';
import type { Rates } from './history.ts';

// Silence of a node, or age of an output's picture, from which it counts as a fault in s.
const kSilentSeconds = 3;
// A node is slow if its frames take this many times the median of the others, and at least this long.
const kSlowRatio = 1.6;
const kSlowMs = 4;

// Returns the median replay time per frame of the other nodes in ms; NaN: there are none.
function medianOfOthers(node: number, rates: Rates): number {
    const others = [...rates.nodes].filter(([other, rate]) => other !== node && rate.replayMs > 0).map(([, rate]) => rate.replayMs);
    others.sort((a, b) => a - b);
    return others[others.length >> 1] ?? NaN;
}

export function isSlow(node: number, rates: Rates | null): boolean {
    const mine = rates?.nodes.get(node)?.replayMs ?? NaN;
    return rates !== null && mine >= kSlowMs && mine > kSlowRatio * medianOfOthers(node, rates);
}

// Returns the reason of a condition that needs attention; empty: none is known.
export function reasonOf(node: NodeStatus, rates: Rates | null, events: HeadEvent[], log: LogLine[]): string {
    const { word } = conditionOf(node, rates);
    if (word === 'slow')
        return `Replay takes ${ms(rates!.nodes.get(node.node)!.replayMs)} per frame; the median of the other nodes is ${ms(medianOfOthers(node.node, rates!))}.`;
    if (word === 'silent') return `No message for ${duration(node.silentSeconds)}.`;
    if (word !== 'lost' && word !== 'rejoining') return '';
    const event = events.filter(entry => entry.event === 'node-lost' && entry.node === node.node).pop();
    if (typeof event?.text === 'string') return event.text;
    return log.filter(line => line.text.startsWith(`node ${node.node} `) && line.text.includes('lost')).pop()?.text ?? '';
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
