// A chart of time series by uPlot, in the colours of the page.

import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';

export interface Series {
    label: string;
    values: (number | null)[];
}

interface Props {
    title: string;
    x: number[];
    series: Series[];
    height: number;
    format(value: number): string;
    formatX?(value: number): string;
    onRange?(from: number, to: number): void;
}

export const kSeriesColours = 8;

export function colour(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// Dashes distinguish series that share a colour, and lines for people who see no colours.
const kDashes = [[], [6, 3], [2, 3], [8, 3, 2, 3]];

export function Chart({ title, x, series, height, format, formatX, onRange }: Props) {
    const place = useRef<HTMLDivElement>(null);
    const plot = useRef<uPlot | null>(null);
    const range = useRef(onRange);
    range.current = onRange;
    const names = series.map(entry => entry.label).join('\n');
    useEffect(() => {
        const element = place.current!;
        const make = () => {
            plot.current?.destroy();
            const axis = { stroke: colour('--faint'), grid: { stroke: colour('--line'), width: 1 }, ticks: { show: false },
                font: '11px system-ui, sans-serif' };
            plot.current = new uPlot(
                {
                    width: Math.max(60, element.clientWidth),
                    height,
                    cursor: { drag: { x: !!range.current, y: false, setScale: false }, points: { size: 5 } },
                    legend: { live: true },
                    select: { show: !!range.current, left: 0, top: 0, width: 0, height: 0 },
                    scales: { x: { time: false }, y: { range: (_plot, _low, high) => [0, Math.max(high * 1.1, 1e-9)] } },
                    axes: [
                        { ...axis, size: 24, values: (_plot, values) => values.map(value => (formatX ?? String)(value)) },
                        { ...axis, size: 62, values: (_plot, values) => values.map(value => format(value)) },
                    ],
                    series: [
                        { label: 'at', value: (_plot, value) => (value === null ? '–' : (formatX ?? String)(value)) },
                        ...series.map((entry, i) => ({
                            label: entry.label,
                            stroke: colour(`--series-${i % kSeriesColours}`),
                            dash: kDashes[Math.floor(i / kSeriesColours) % kDashes.length] ?? [],
                            width: 1.5,
                            points: { show: false },
                            value: (_plot: uPlot, value: number | null) => (value === null ? '–' : format(value)),
                        })),
                    ],
                    hooks: {
                        setSelect: [
                            self => {
                                const { left, width } = self.select;
                                if (width < 4) return;
                                range.current?.(self.posToVal(left, 'x'), self.posToVal(left + width, 'x'));
                                self.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
                            },
                        ],
                    },
                },
                [x, ...series.map(entry => entry.values)] as uPlot.AlignedData,
                element,
            );
        };
        make();
        const scheme = matchMedia('(prefers-color-scheme: dark)');
        scheme.addEventListener('change', make);
        const resize = new ResizeObserver(() => plot.current?.setSize({ width: Math.max(60, element.clientWidth), height }));
        resize.observe(element);
        return () => {
            scheme.removeEventListener('change', make);
            resize.disconnect();
            plot.current?.destroy();
            plot.current = null;
        };
    }, [names, height]);
    useEffect(() => plot.current?.setData([x, ...series.map(entry => entry.values)] as uPlot.AlignedData), [x, series]);
    return <div ref={place} class="chart" role="img" aria-label={title} />;
}
