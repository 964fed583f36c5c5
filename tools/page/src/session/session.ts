// The state of the session as the page knows it, and its operations.

import { PictureHub } from '../pictures/picture_hub.ts';
import { canDecodeVideo } from '../pictures/video_path.ts';
import { Connection, OperationError, socketAddress, type ConnectionState } from '../wire/connection.ts';
import type {
    Equalizer, FramesReply, HeadEvent, LogLine, Output, Role, Status, Viewer, Wall, Welcome,
} from '../wire/types.ts';
import { Cell } from './cell.ts';
import { FrameStore } from './frame_store.ts';
import { History } from './history.ts';
import { InputClock } from './input_clock.ts';
import { withNames } from './wall_geometry.ts';

export interface Notice {
    id: number;
    kind: 'info' | 'error';
    text: string;
}

const kSameRatio = 0.02; // pictures are reduced to whole pixels
const kMostLogLines = 500;
const kMostEvents = 100;
const kNoticeMs = 8000;
const kRanks: Record<Role, number> = { view: 0, input: 1, operate: 2 };

export class Session {
    readonly connection = new Cell<ConnectionState>({ phase: 'connecting', reason: '', retryAtMs: 0 });
    readonly welcome = new Cell<Welcome | null>(null);
    readonly status = new Cell<Status | null>(null);
    readonly wall = new Cell<Wall | null>(null);
    readonly viewers = new Cell<Viewer[]>([]);
    readonly outputs = new Cell<Output[]>([]);
    readonly log = new Cell<LogLine[]>([]);
    readonly events = new Cell<(HeadEvent & { receivedMs: number })[]>([]);
    readonly notices = new Cell<Notice[]>([]);
    readonly roundTripMs = new Cell(NaN);
    // Time of performance.now() at which the newest hashes of outputs arrived.
    outputsAtMs = 0;
    readonly history = new History();
    readonly frames = new FrameStore();
    readonly input = new InputClock();
    readonly pictures: PictureHub;
    private readonly link: Connection;
    private canUseVideo = false;
    private lastNotice = 0;
    // State that the wall belongs to; empty: its request has failed; null: its first request is under way.
    private wallKey: string | null = '';
    private timelineUsers = 0;

    constructor(private token: string, readonly name: string) {
        this.link = new Connection(
            socketAddress(location.href),
            () => ({
                token: this.token,
                name: this.name,
                canUse: { h264: this.canUseVideo },
                px: [Math.round(innerWidth * devicePixelRatio), Math.round(innerHeight * devicePixelRatio)],
            }),
            {
                onState: state => (this.connection.value = state),
                onWelcome: welcome => this.onWelcome(welcome),
                onTopic: (topic, data, dropped) => this.onTopic(topic, data, dropped),
                onPictures: message => this.pictures.onMessage(message),
                onRoundTrip: ms => (this.roundTripMs.value = ms),
            },
        );
        this.pictures = new PictureHub({
            request: (op, args) => this.link.request(op, args),
            send: message => this.link.send(message),
            onVideoGivenUp: () => {
                this.canUseVideo = false;
                this.notify('info', 'The video decoder of this browser stalls. Pictures continue as JPEG.');
                this.link.reconnect();
            },
            onInputShown: lastInput => this.input.onShown(lastInput),
        });
    }

    async start(): Promise<void> {
        this.canUseVideo = await canDecodeVideo();
        if (this.token) this.link.connect();
        else this.connection.value = { phase: 'refused', reason: 'this address has no token', retryAtMs: 0 };
    }

    useToken(token: string): void {
        this.token = token;
        this.link.reconnect();
    }

    retry(): void {
        this.link.reconnect();
    }

    may(role: Role): boolean {
        return kRanks[this.welcome.value?.role ?? 'view'] >= kRanks[role];
    }

    get self(): Viewer | undefined {
        return this.viewers.value.find(viewer => viewer.client === this.welcome.value?.client);
    }

    get holder(): Viewer | undefined {
        return this.viewers.value.find(viewer => viewer.holder);
    }

    // Performs an operation. Rejects with OperationError.
    request<Result = Record<string, unknown>>(op: string, args: Record<string, unknown> = {}): Promise<Result> {
        return this.link.request<Result>(op, args);
    }

    // Performs an operation, and shows its error or `done`. Returns null after an error.
    async perform<Result = Record<string, unknown>>(
        op: string,
        args: Record<string, unknown> = {},
        done = '',
    ): Promise<Result | null> {
        try {
            const result = await this.request<Result>(op, args);
            if (done) this.notify('info', done);
            return result;
        } catch (error) {
            const text = error instanceof OperationError ? error.message : String(error);
            this.notify('error', `${op}: ${text}`);
            return null;
        }
    }

    // Requests a document of the page's server.
    async fetch(path: string): Promise<Response> {
        const response = await fetch(path, { headers: { Authorization: 'Bearer ' + this.token } });
        if (!response.ok) throw new Error(`${path.replace(/\?.*/, '')}: ${await errorOf(response)}`);
        return response;
    }

    send(message: Record<string, unknown>): void {
        this.link.send(message);
    }

    notify(kind: Notice['kind'], text: string): void {
        const notice = { id: ++this.lastNotice, kind, text };
        this.notices.value = [...this.notices.value.slice(-3), notice];
        setTimeout(() => this.dismiss(notice.id), kind === 'error' ? 2 * kNoticeMs : kNoticeMs);
    }

    dismiss(id: number): void {
        this.notices.value = this.notices.value.filter(notice => notice.id !== id);
    }

    // Subscribes to the timeline while at least one view uses it. Returns the end of the use.
    useTimeline(): () => void {
        if (this.timelineUsers++ === 0) this.subscribe('timeline', 500);
        return () => {
            if (--this.timelineUsers === 0) this.request('unsubscribe', { topic: 'timeline' }).catch(() => undefined);
        };
    }

    async refreshWall(): Promise<void> {
        try {
            this.wall.value = withNames(await this.request<Wall>('wall'));
        } catch {
            this.wallKey = '';
        }
    }

    private onWelcome(welcome: Welcome): void {
        if (welcome.session.session !== this.welcome.value?.session.session) {
            this.frames.clear();
            this.log.value = [];
            this.events.value = [];
        }
        // Views that show the wall; the fragment is empty for the first of them.
        this.pictures.onConnected(/^#?(wall|use|balance)?(\/|$)/.test(location.hash));
        this.welcome.value = welcome;
        this.subscribe('status', 1000);
        this.subscribe('events', 200);
        this.subscribe('clients');
        this.subscribe('outputs');
        if (this.may('operate')) this.subscribe('log', 300);
        if (this.timelineUsers > 0) this.subscribe('timeline', 500);
        this.wallKey = null;
        void this.refreshWall();
    }

    // The server refuses topics that the role may not read; the views then have nothing to show.
    private subscribe(topic: string, interval?: number): void {
        this.request('subscribe', interval ? { topic, interval } : { topic }).catch(() => undefined);
    }

    private onTopic(topic: string, data: unknown, dropped: number): void {
        if (topic === 'status') this.onStatus(data as Status);
        else if (topic === 'clients') this.viewers.value = data as Viewer[];
        else if (topic === 'timeline') this.frames.add(data as FramesReply);
        else if (topic === 'events') this.onEvents(data as HeadEvent[]);
        else if (topic === 'outputs') {
            this.outputsAtMs = performance.now();
            this.outputs.value = data as Output[];
        } else if (topic === 'log') {
            const lines = data as LogLine[];
            const gap = dropped > 0 ? [{ atSeconds: NaN, topic: 'page', level: 'info', text: `${dropped} lines are missing` }] : [];
            this.log.value = [...this.log.value, ...gap, ...lines].slice(-kMostLogLines);
        }
    }

    private onStatus(status: Status): void {
        this.history.add(status);
        this.status.value = status;
        const key = status.session + status.tiles + status.nodes.map(node => node.node).join();
        const isStale = this.wallKey !== null && (this.wallKey !== key || this.hasOtherSize());
        this.wallKey = key;
        if (isStale) void this.refreshWall();
    }

    // The server knows the size of the program's picture from the first picture on, and programs change it.
    private hasOtherSize(): boolean {
        const wall = this.pictures.stream('wall');
        if (!this.wall.value || !wall.hasPicture) return false;
        const [width, height] = this.wall.value.program.size;
        const ratio = (wall.canvas.width * height) / (wall.canvas.height * width);
        return !(Math.abs(ratio - 1) < kSameRatio);
    }

    private onEvents(events: HeadEvent[]): void {
        const receivedMs = performance.now();
        const news = events.filter(event => event.event !== 'frame').map(event => ({ ...event, receivedMs }));
        if (news.length) this.events.value = [...this.events.value, ...news].slice(-kMostEvents);
    }
}

async function errorOf(response: Response): Promise<string> {
    const text = await response.text().catch(() => '');
    try {
        const { error } = JSON.parse(text);
        if (typeof error === 'string') return error;
    } catch {
        // A short text is the reason itself.
        if (text && text.length < 300 && !text.startsWith('<')) return text.trim();
    }
    return `${response.status} ${response.statusText}`.trim();
}

export function equalizersOf(status: Status | null): Equalizer[] {
    return status?.equalizers ?? [];
}
