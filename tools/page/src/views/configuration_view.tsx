// The configuration of the session as a drawing, a tree and a text, and its changes.

import { useEffect, useMemo, useState } from 'preact/hooks';
import { SafeSvg } from '../parts/safe_svg.tsx';
import { Tabs } from '../parts/tabs.tsx';
import { useCell } from '../session/cell.ts';
import { parseEqc, type EqcNode } from '../session/eqc_tree.ts';
import type { Session } from '../session/session.ts';
import { LayoutChange, PlanOptions } from './plan_changes.tsx';
import { saveBlob } from './save_document.ts';
import type { ViewProps } from './view.ts';

function useDocument(session: Session, path: string): { text: string; error: string } {
    const [state, setState] = useState({ text: '', error: '' });
    const wall = useCell(session.wall);
    useEffect(() => {
        let isOver = false;
        session.fetch(path).then(response => response.text())
            .then(text => { if (!isOver) setState({ text, error: '' }); })
            .catch(error => { if (!isOver) setState({ text: '', error: String(error.message ?? error) }); });
        return () => { isOver = true; };
    }, [session, path, wall]);
    return state;
}

function Tree({ nodes, depth }: { nodes: EqcNode[]; depth: number }) {
    return (
        <ul class="tree">
            {nodes.map((node, i) => {
                const line = <><b>{node.name}</b> <code>{node.values.join(' ')}</code></>;
                return (
                    <li key={i}>
                        {node.children.length === 0 ? <span class="leaf">{line}</span> : (
                            <details open={depth < 3}>
                                <summary>{line}</summary>
                                <Tree nodes={node.children} depth={depth + 1} />
                            </details>
                        )}
                    </li>
                );
            })}
        </ul>
    );
}

function Document({ session, form }: { session: Session; form: string }) {
    const drawing = useDocument(session, 'api/v1/config.svg');
    const text = useDocument(session, 'api/v1/config.eqc');
    const tree = useMemo(() => parseEqc(text.text), [text.text]);
    const shown = form === 'drawing' ? drawing : text;
    if (shown.error) return <p class="empty">{shown.error}</p>;
    if (!shown.text) return <p class="empty">Loading.</p>;
    if (form === 'drawing') return <SafeSvg text={drawing.text} label="Drawing of displays, machines and compounds" />;
    if (form === 'tree') return <Tree nodes={tree} depth={0} />;
    return (
        <>
            <div class="buttons"><button onClick={() => saveBlob(new Blob([text.text], { type: 'text/plain' }), 'wall.eqc')}>Save file</button></div>
            <pre tabIndex={0} aria-label="Text of the configuration">{text.text}</pre>
        </>
    );
}

export function ConfigurationView({ session }: ViewProps) {
    const [form, setForm] = useState('drawing');
    if (!session.may('operate')) return <p class="empty">This link does not show the configuration.</p>;
    return (
        <div class="columns">
            <section>
                <Tabs label="Form of the configuration" value={form} onChange={setForm}
                    tabs={[['drawing', 'Drawing'], ['tree', 'Tree'], ['text', 'Text']]}>
                    <Document session={session} form={form} />
                </Tabs>
            </section>
            <section class="card">
                <h2>Layout</h2>
                <LayoutChange session={session} />
                <h2>Plan</h2>
                <p class="faint">A change applies to all nodes at one frame of the program.</p>
                <PlanOptions session={session} />
                <div class="buttons">
                    <button onClick={() => session.perform('undo', {}, 'The previous plan is back.')}>Undo the last change</button>
                </div>
            </section>
        </div>
    );
}
