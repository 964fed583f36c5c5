// Shapes of the messages between the page and the browser (docs/reference/page.md, control.md, statistics.md).

export type Role = 'view' | 'input' | 'operate';
export type NodeState = 'alive' | 'lost' | 'stopped' | 'rejoining';
export type PictureClass = 'thumb' | 'preview' | 'full' | 'off';

export interface NodeStatus {
    node: number;
    where: string;
    pid: number;
    gl: string;
    state: NodeState;
    stream: string;
    silentSeconds: number;
    frames: number;
    replaySeconds: number;
    readbackSeconds: number;
    pictureBytes: number;
    pictureRawBytes: number;
    joins: number;
    secondsToRejoin: number;
    snapshotBytes: number;
    // Members of later heads.
    [member: string]: unknown;
}

export interface ProgramStatus {
    client: number;
    pid: number;
    command: string;
    frames: number;
    calls: number;
    bytes: number;
    roundTrips: number;
    roundTripsBy: Record<string, number>;
    waitSeconds: Record<string, number>;
    waitingFor: string | null;
    waitsForNodes: number[];
}

export interface Equalizer {
    name: string;
    kind: string;
    divides: string;
    decision: string;
    efficiency: number;
    frames: number;
    framesPerSecond: number;
    frozen: boolean;
    moves: number;
    taken: number;
    zoom: number;
    nodes: { node: number; part: number }[];
    parameters: Record<string, string>;
}

export interface Recording {
    file: string;
    firstFrame: number;
    frames: number;
    bytes: number;
    complete: boolean;
}

export interface Status {
    session: string;
    runPid: number;
    headPid: number;
    atSeconds: number;
    tiles: string;
    display: string;
    frames: number;
    latency: number;
    revertsInSeconds: number | null;
    recording: Recording | null;
    equalizers: Equalizer[] | null;
    delta: Record<string, number> | null;
    multicast?: Record<string, number> | null;
    programs: ProgramStatus[];
    nodes: NodeStatus[];
}

// [x, y, width, height] from the upper left corner.
export type Rect = [number, number, number, number];

export interface Segment {
    name: string;
    rectMm: Rect;
    turn: number;
    // The server sends null for a segment without a node.
    node: number;
    channel: string;
    rectPx: Rect;
}

export interface Canvas {
    name: string;
    layout: string | null;
    layouts: string[];
    sizeMm: [number, number];
    sizePx: [number, number];
    segments: Segment[];
}

export interface Wall {
    canvases: Canvas[];
    program: { size: [number, number] };
}

export interface Output {
    canvas?: string;
    output: string;
    node: number;
    hash: string;
    frame: number;
    ageSeconds: number;
    // Time after the first window that showed this frame; null: the head has the picture.
    skewMs: number | null;
}

export interface Viewer {
    client: number;
    name: string;
    role: Role;
    holder: boolean;
}

export interface LogLine {
    atSeconds: number;
    topic: string;
    level: string;
    text: string;
}

export interface HeadEvent {
    event: string;
    [member: string]: unknown;
}

export interface Track {
    process: 'program' | 'head' | 'node';
    number: number;
    thread: string;
    spans: [number, number, number][];
}

export interface FrameRecord {
    number: number;
    client: number;
    window: number;
    frame: number;
    doneNs: number;
    tracks: Track[];
}

export interface FramesReply {
    frames: FrameRecord[];
    next: number;
    more: boolean;
    kinds: string[];
    clocks: { node: number; offsetNs: number; errorNs: number }[];
}

export interface PlanChange {
    joined?: number[];
    left?: number[];
    kept?: number[];
    warnings?: string[];
    seconds?: number;
    revertsInSeconds?: number;
}

export interface Link {
    link: number;
    name: string;
    role: Role;
    secondsLeft: number | null;
    most: number;
    open: number;
}

export interface Welcome {
    role: Role;
    session: { mural?: string; session?: string; runPid?: number; headPid?: number; [member: string]: unknown };
    client: number;
    limits: Record<string, number>;
}
