// A canvas that shows a stream, or a part of it. It requests the class that its size needs, while it is visible.

import { useEffect, useRef } from 'preact/hooks';
import { classForWidth, type PictureHub, type PictureOf } from '../pictures/picture_hub.ts';
import type { Rect } from '../wire/types.ts';

interface Props {
    hub: PictureHub;
    of: PictureOf;
    // For screen readers; empty: the parent has a label.
    label: string;
    // Part of the picture, as fractions; missing: the whole picture.
    part?: Rect;
    isPreviewOnly?: boolean;
    // Pixels of the canvas are those of the picture.
    isOneToOne?: boolean;
    onSize?(width: number, height: number): void;
}

const kMostPixels = 4096;
let isFirst = true;

export function Picture({ hub, of, label, part, isPreviewOnly, isOneToOne, onSize }: Props) {
    const ref = useRef<HTMLCanvasElement>(null);
    const key = part ? part.join() : '';
    useEffect(() => {
        const canvas = ref.current!;
        const stream = hub.stream(of);
        const view = Symbol();
        const [left, top, width, height] = part ?? [0, 0, 1, 1];
        let isVisible = false;
        let lastWidth = 0;
        let lastHeight = 0;
        const draw = () => {
            if (!stream.hasPicture || !isVisible) return;
            const from = stream.canvas;
            const context = canvas.getContext('2d', { alpha: false })!;
            if (isOneToOne && (canvas.width !== from.width || canvas.height !== from.height)) {
                canvas.width = from.width;
                canvas.height = from.height;
            }
            context.imageSmoothingQuality = 'high';
            context.drawImage(from, left * from.width, top * from.height, width * from.width, height * from.height,
                0, 0, canvas.width, canvas.height);
            canvas.dataset.frame = String(stream.frame);
            if (isFirst) performance.mark('mural-first-picture');
            isFirst = false;
            if (from.width !== lastWidth || from.height !== lastHeight) onSize?.((lastWidth = from.width), (lastHeight = from.height));
        };
        const want = () => {
            if (!isVisible || canvas.clientWidth === 0) return hub.want(view, of, 'off');
            const pixels = (canvas.clientWidth * devicePixelRatio) / width;
            const fitting = classForWidth(pixels);
            hub.want(view, of, isOneToOne ? 'full' : isPreviewOnly && fitting === 'full' ? 'preview' : fitting);
        };
        const resize = new ResizeObserver(() => {
            if (!isOneToOne) {
                canvas.width = Math.min(kMostPixels, Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio)));
                canvas.height = Math.min(kMostPixels, Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio)));
            }
            want();
            draw();
        });
        const visible = new IntersectionObserver(entries => {
            isVisible = entries[entries.length - 1]!.isIntersecting;
            want();
            draw();
        });
        const end = stream.listen(draw);
        resize.observe(canvas);
        visible.observe(canvas);
        return () => {
            end();
            resize.disconnect();
            visible.disconnect();
            hub.want(view, of, 'off');
        };
    }, [hub, of, key, isPreviewOnly, isOneToOne]);
    const role = label ? { role: 'img' as const, 'aria-label': label } : { 'aria-hidden': true };
    return <canvas ref={ref} class="picture" width="1" height="1" {...role} />;
}
