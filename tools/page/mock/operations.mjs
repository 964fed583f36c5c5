// The operations of the made-up session, with the checks that tests of the page need.

export class Refusal extends Error {
    constructor(code, text) {
        super(text);
        this.code = code;
    }
}

export const kRanks = { view: 0, input: 1, operate: 2 };
const kReading = new Set(['status', 'nodes', 'frames', 'equalizers', 'unsubscribe', 'preview', 'wall']);
const kSettings = new Set(['latency', 'overlay', 'layout', 'plan', 'log-level']);
const kTopics = new Set(['status', 'log', 'events', 'timeline', 'clients', 'outputs']);

export function requiredRole(op, args) {
    if (kReading.has(op)) return 'view';
    if (op === 'subscribe') return args.topic === 'log' ? 'operate' : 'view';
    if (kSettings.has(op)) return Object.keys(args).length ? 'operate' : 'view';
    return op === 'input-take' || op === 'input-release' ? 'input' : 'operate';
}

function nodeOf(scene, args) {
    const node = scene.node(args.node);
    if (!node) throw new Refusal('failed', `this session has no node ${args.node}`);
    return node;
}

function change(scene, args) {
    const result = { joined: [4], left: [0], kept: [1, 2, 3], warnings: args['dry-run'] ? ['node 0 and node 1 share one GPU'] : [] };
    if (args['dry-run']) return result;
    if (scene.status.revertsInSeconds !== null) throw new Refusal('failed', 'an earlier change waits for keep or undo');
    if (args['revert-after']) scene.status.revertsInSeconds = result.revertsInSeconds = args['revert-after'];
    return { ...result, seconds: 0.42 };
}

const kOperations = {
    status: scene => scene.status,
    nodes: scene => ({ nodes: scene.status.nodes }),
    equalizers: scene => ({ equalizers: scene.status.equalizers }),
    frames: (scene, args) => scene.frames(Math.min(600, args.newest ?? 600)),
    wall: scene => scene.wall(),
    plan: (scene, args) => (args.options ? change(scene, args) : scene.plan),
    layout: (scene, args) => change(scene, args),
    'move-nodes': (scene, args) => change(scene, args),
    keep(scene) {
        scene.status.revertsInSeconds = null;
        return {};
    },
    undo(scene) {
        scene.status.revertsInSeconds = null;
        return { joined: [], left: [], kept: [0, 1, 2, 3], warnings: [], seconds: 0.2 };
    },
    latency(scene, args) {
        if (args.frames !== undefined) scene.status.latency = args.frames;
        return { latency: scene.status.latency };
    },
    overlay(scene, args) {
        if (args.node !== undefined) scene.overlays.set(args.node, args.mode);
        return { overlay: 'off', nodes: scene.status.nodes.map(({ node }) => ({ node, overlay: scene.overlays.get(node) ?? 'off' })) };
    },
    'restart-node'(scene, args) {
        nodeOf(scene, args).state = 'rejoining';
        setTimeout(() => scene.revive(args.node), 1200).unref();
        return {};
    },
    'start-node'(scene, args) {
        nodeOf(scene, args).state = 'rejoining';
        setTimeout(() => scene.revive(args.node), 1200).unref();
        return {};
    },
    'stop-node'(scene, args) {
        const node = nodeOf(scene, args);
        if (!args.force) throw new Refusal('failed', `no other node takes the area of node ${args.node}; its part stays as it is with force`);
        node.state = 'stopped';
        return {};
    },
    'equalizer-freeze'(scene, args) {
        scene.status.equalizers.find(entry => entry.name === args.name).frozen = args.frozen;
        return {};
    },
    'equalizer-set'(scene, args) {
        if (!/^[-\d. infON]+$/.test(args.value)) throw new Refusal('failed', `${args.parameter}: "${args.value}" is not a number`);
        scene.status.equalizers.find(entry => entry.name === args.name).parameters[args.parameter] = args.value;
        return {};
    },
    'record-start'(scene, args) {
        scene.status.recording = { file: args.file, firstFrame: scene.frame + 1, frames: 0, bytes: 0, complete: true };
        return scene.status.recording;
    },
    'record-stop'(scene) {
        const recording = scene.status.recording;
        scene.status.recording = null;
        return recording ?? {};
    },
    stop: () => ({}),
    links: scene => ({ links: scene.links.map(({ token: _token, ...link }) => link) }),
    'link-new'(scene, args) {
        const link = { link: scene.links.length + 1, name: args.name, role: args.role, secondsLeft: args.seconds || null, most: args.most, open: 0 };
        scene.links.push({ ...link, token: 'mock-' + link.link });
        return { link: link.link, token: 'q7Yx0mJc2VbN8sLr4TzKfPwE1uHdGa9iRo5tMk3XyZA' };
    },
    'link-revoke'(scene, args) {
        scene.links = scene.links.filter(link => link.link !== args.link);
        return {};
    },
};

// Performs an operation of a client. Throws Refusal.
export function perform(scene, client, op, args) {
    if (kRanks[client.role] < kRanks[requiredRole(op, args)]) throw new Refusal('denied', `${op} requires the role ${requiredRole(op, args)}`);
    if (op === 'subscribe') {
        if (!kTopics.has(args.topic)) throw new Refusal('bad-argument', `there is no topic "${args.topic}"`);
        client.topics.set(args.topic, { interval: args.interval ?? 1000, nextMs: 0 });
        return { topic: args.topic, interval: args.interval ?? 1000 };
    }
    if (op === 'unsubscribe') return client.topics.delete(args.topic), {};
    if (op === 'preview') {
        client.previews.set(args.of, args.class);
        client.needsKey = true;
        return {};
    }
    if (op === 'input-take') return (scene.holder = client.client), {};
    if (op === 'input-release') return (scene.holder = null), {};
    const operation = kOperations[op];
    if (!operation) throw new Refusal('unknown-operation', `there is no operation "${op}"`);
    return operation(scene, args);
}
