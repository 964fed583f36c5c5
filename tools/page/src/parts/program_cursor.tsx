// The pointer of the program over its picture, in the shape that the program gives it. It follows the viewer in control
// at once, and other viewers see where the program has it.

import { useEffect, useRef } from 'preact/hooks';
import type { RefObject } from 'preact';
import type { PictureStream } from '../pictures/picture_stream.ts';

interface Props {
    stream: PictureStream;
    surface: RefObject<HTMLElement | null>;
    isOwn: boolean;
}

export function ProgramCursor({ stream, surface, isOwn }: Props) {
    const ref = useRef<HTMLCanvasElement>(null);
    useEffect(() => {
        const canvas = ref.current!;
        const element = surface.current!;
        const stop = new AbortController();
        let own: { x: number; y: number } | null = null;
        let drawn: ImageBitmap | null = null;
        const place = () => {
            const { cursor } = stream;
            const at = isOwn ? own : cursor?.isHidden ? null : cursor && { x: cursor.x * element.clientWidth, y: cursor.y * element.clientHeight };
            canvas.hidden = !cursor || !at;
            // Without a shape the browser shows its own pointer.
            element.classList.toggle('has-cursor', isOwn && cursor !== null);
            if (!cursor || !at) return;
            if (drawn !== cursor.picture) {
                drawn = cursor.picture;
                canvas.width = drawn.width;
                canvas.height = drawn.height;
                canvas.getContext('2d')!.drawImage(drawn, 0, 0);
                canvas.dataset.shape = `${drawn.width}x${drawn.height}+${cursor.hotX}+${cursor.hotY}`;
            }
            canvas.style.transform = `translate(${Math.round(at.x - cursor.hotX)}px, ${Math.round(at.y - cursor.hotY)}px)`;
        };
        const end = stream.listen(place);
        if (isOwn) {
            element.addEventListener('pointermove', event => {
                const box = element.getBoundingClientRect();
                own = event.pointerType === 'mouse' ? { x: event.clientX - box.left, y: event.clientY - box.top } : null;
                place();
            }, { signal: stop.signal });
            element.addEventListener('pointerleave', () => {
                own = null;
                place();
            }, { signal: stop.signal });
        }
        place();
        return () => {
            end();
            stop.abort();
            element.classList.remove('has-cursor');
        };
    }, [stream, isOwn]);
    return <canvas ref={ref} class="program-cursor" width="1" height="1" hidden aria-hidden />;
}
