// The WebSocket to the page's server: greeting, requests with replies, topics, pictures, and new attempts after a loss.

import type { Welcome } from './types.ts';

export type Phase = 'connecting' | 'open' | 'lost' | 'refused';

export interface ConnectionState {
    phase: Phase;
    // Reason of the loss or refusal; empty otherwise.
    reason: string;
    // Time of performance.now() of the next attempt in ms; 0: none is planned.
    retryAtMs: number;
}

export interface ConnectionEvents {
    onState(state: ConnectionState): void;
    onWelcome(welcome: Welcome): void;
    onTopic(topic: string, data: unknown, dropped: number): void;
    onPictures(message: ArrayBuffer): void;
    onRoundTrip(ms: number): void;
}

export class OperationError extends Error {
    constructor(
        readonly code: string,
        text: string,
    ) {
        super(text);
    }
}

interface Pending {
    resolve(result: unknown): void;
    reject(error: OperationError): void;
    timer: ReturnType<typeof setTimeout>;
}

// Close code of a token that the server does not accept.
export const kRefusedCode = 4401;
const kTooManyCode = 4429;
const kReasons: Record<number, string> = { 4410: 'the session has ended', [kTooManyCode]: 'this link has too many open pages' };
const kDelaysMs = [500, 1000, 2000, 4000, 8000, 15000];
const kGreetingMs = 8000;
const kPingMs = 5000;
// The server answers pings, so a longer silence is a loss.
const kSilenceMs = 16000;
// Changes of the plan take up to 60 s.
const kRequestMs = 70000;

// Returns the address of the WebSocket beside the page.
export function socketAddress(page: string): string {
    const address = new URL('ws', page.replace(/[#?].*$/, ''));
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    return address.href;
}

export function retryDelayMs(attempt: number): number {
    return kDelaysMs[Math.min(attempt, kDelaysMs.length - 1)]!;
}

export class Connection {
    private socket: WebSocket | null = null;
    private pending = new Map<number, Pending>();
    private lastId = 0;
    private attempt = 0;
    private isWelcome = false;
    private heardAtMs = 0;
    private timers = new Set<ReturnType<typeof setTimeout>>();
    private pinger: ReturnType<typeof setInterval> | undefined;

    constructor(
        private readonly address: string,
        private readonly hello: () => Record<string, unknown>,
        private readonly events: ConnectionEvents,
    ) {}

    connect(): void {
        this.clearTimers();
        this.report('connecting');
        const socket = new WebSocket(this.address, 'mural.v1');
        socket.binaryType = 'arraybuffer';
        this.socket = socket;
        this.isWelcome = false;
        this.heardAtMs = performance.now();
        this.later(kGreetingMs, () => {
            if (!this.isWelcome) this.end(socket, 'the server did not answer');
        });
        socket.onopen = () => socket.send(JSON.stringify({ hello: this.hello() }));
        socket.onmessage = event => {
            this.heardAtMs = performance.now();
            if (typeof event.data === 'string') this.receive(event.data);
            else this.events.onPictures(event.data as ArrayBuffer);
        };
        socket.onclose = event => this.onClose(socket, event.code, event.reason);
    }

    // Ends the connection and begins a new one at once, such as with another greeting.
    reconnect(): void {
        const socket = this.socket;
        this.socket = null;
        socket?.close(1000);
        this.failPending('the connection begins anew');
        this.attempt = 0;
        this.connect();
    }

    close(): void {
        this.clearTimers();
        const socket = this.socket;
        this.socket = null;
        socket?.close(1000);
        this.failPending('the page has closed the connection');
    }

    // Performs an operation. Rejects with OperationError.
    request<Result>(op: string, args: Record<string, unknown> = {}): Promise<Result> {
        const id = ++this.lastId;
        return new Promise<Result>((resolve, reject) => {
            if (!this.isWelcome) {
                reject(new OperationError('lost', 'no connection to the session'));
                return;
            }
            const timer = setTimeout(() => {
                this.pending.delete(id);
                reject(new OperationError('timeout', `no reply to ${op} within ${kRequestMs / 1000} s`));
            }, kRequestMs);
            this.pending.set(id, { resolve: resolve as (result: unknown) => void, reject, timer });
            this.send({ id, op, args });
        });
    }

    // Sends a message without a reply. Without a connection it does nothing.
    send(message: Record<string, unknown>): void {
        if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
    }

    private receive(text: string): void {
        let message: Record<string, any>;
        try {
            message = JSON.parse(text);
        } catch {
            return;
        }
        if ('topic' in message) this.events.onTopic(message.topic, message.data, message.dropped ?? 0);
        else if ('id' in message) this.onReply(message);
        else if ('pong' in message) this.events.onRoundTrip(performance.now() - message.pong);
        else if ('welcome' in message) this.onWelcome(message.welcome);
    }

    private onWelcome(welcome: Welcome): void {
        this.isWelcome = true;
        this.attempt = 0;
        this.report('open');
        clearInterval(this.pinger);
        this.pinger = setInterval(() => {
            const socket = this.socket;
            if (socket && performance.now() - this.heardAtMs > kSilenceMs) this.end(socket, 'the server is silent');
            else this.send({ ping: performance.now() });
        }, kPingMs);
        this.events.onWelcome(welcome);
        this.send({ ping: performance.now() });
    }

    private onReply(message: Record<string, any>): void {
        const pending = this.pending.get(message.id);
        if (!pending) return;
        this.pending.delete(message.id);
        clearTimeout(pending.timer);
        if (message.ok) pending.resolve(message.result);
        else pending.reject(new OperationError(String(message.code), String(message.error)));
    }

    private end(socket: WebSocket, reason: string): void {
        if (socket !== this.socket) return;
        socket.onclose = null;
        socket.close();
        this.onClose(socket, 1006, reason);
    }

    private onClose(socket: WebSocket, code: number, reason: string): void {
        if (socket !== this.socket) return;
        this.socket = null;
        this.isWelcome = false;
        this.clearTimers();
        this.failPending('the connection to the session is lost');
        if (code === kRefusedCode) {
            this.report('refused', reason || 'this link is unknown, expired or revoked');
            return;
        }
        if (code === kTooManyCode) this.attempt = kDelaysMs.length;
        const delay = retryDelayMs(this.attempt++);
        this.report('lost', reason || kReasons[code] || 'the connection ended', performance.now() + delay);
        this.later(delay, () => this.connect());
    }

    private failPending(text: string): void {
        for (const pending of this.pending.values()) {
            clearTimeout(pending.timer);
            pending.reject(new OperationError('lost', text));
        }
        this.pending.clear();
    }

    private report(phase: Phase, reason = '', retryAtMs = 0): void {
        this.events.onState({ phase, reason, retryAtMs });
    }

    private later(ms: number, action: () => void): void {
        const timer = setTimeout(() => {
            this.timers.delete(timer);
            action();
        }, ms);
        this.timers.add(timer);
    }

    private clearTimers(): void {
        for (const timer of this.timers) clearTimeout(timer);
        this.timers.clear();
        clearInterval(this.pinger);
        this.pinger = undefined;
    }
}
