// Recording of the programs' GL streams, and pictures of the wall as files.

import { useState } from 'preact/hooks';
import { bytes, count } from '../parts/format.ts';
import { StateMark } from '../parts/state_mark.tsx';
import { useCell } from '../session/cell.ts';
import type { Recording } from '../wire/types.ts';
import { saveDocument } from './save_document.ts';
import type { ViewProps } from './view.ts';

export function RecordView({ session }: ViewProps) {
    const status = useCell(session.status);
    const [file, setFile] = useState('wall.mural');
    const [last, setLast] = useState<Recording | null>(null);
    const recording = status?.recording ?? null;
    const start = async (event: Event) => {
        event.preventDefault();
        setLast(null);
        await session.perform<Recording>('record-start', { file }, 'The recording begins with the next frame of the wall.');
    };
    const stop = async () => setLast(await session.perform<Recording>('record-stop', {}, 'The recording has ended.'));
    const shown = recording ?? last;
    return (
        <div class="columns">
            <section class="card">
                <h2>GL stream</h2>
                <p><StateMark mark={recording ? (recording.complete ? 'good' : 'bad') : 'idle'}
                    word={recording ? (recording.complete ? 'records' : 'incomplete') : 'no recording'} /></p>
                {shown && (
                    <dl class="facts">
                        <div><dt>File</dt><dd><code>{shown.file}</code></dd></div>
                        <div><dt>Frames</dt><dd>{count(shown.frames)}, from frame {count(shown.firstFrame)} of the wall</dd></div>
                        <div><dt>Size</dt><dd>{bytes(shown.bytes)}</dd></div>
                    </dl>
                )}
                {session.may('operate') ? (recording ? (
                    <div class="buttons"><button class="primary" onClick={stop}>End the recording</button></div>
                ) : (
                    <form class="row" onSubmit={start}>
                        <label><span>File on the head's machine</span>
                            <input value={file} required spellcheck={false} autocomplete="off" onInput={event => setFile(event.currentTarget.value)} /></label>
                        <button class="primary">Record</button>
                    </form>
                )) : <p class="faint">This link does not start recordings.</p>}
                <p class="faint">An existing file is replaced. <code>mural replay</code> shows the recording on any wall.</p>
            </section>
            <section class="card">
                <h2>Picture of the wall</h2>
                <div class="buttons">
                    <button onClick={() => saveDocument(session, 'api/v1/picture.png', `mural-${status?.frames ?? 0}.png`)}>Save PNG</button>
                    <button onClick={() => saveDocument(session, 'api/v1/picture.jpg?w=1920&q=90', `mural-${status?.frames ?? 0}.jpg`)}>Save JPEG</button>
                </div>
            </section>
        </div>
    );
}
