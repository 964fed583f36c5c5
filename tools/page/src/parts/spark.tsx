// A line of the last values without axes, with its newest value in words for screen readers.

interface Props {
    values: number[];
    label: string;
    most?: number;
}

const kWidth = 120;
const kHeight = 28;

export function Spark({ values, label, most }: Props) {
    const finite = values.filter(Number.isFinite);
    const top = most ?? Math.max(1e-9, ...finite) * 1.15;
    const step = kWidth / Math.max(1, values.length - 1);
    let path = '';
    let isBroken = true;
    values.forEach((value, i) => {
        if (!Number.isFinite(value)) {
            isBroken = true;
            return;
        }
        const y = kHeight - 1 - (Math.min(value, top) / top) * (kHeight - 2);
        path += `${isBroken ? 'M' : 'L'}${(i * step).toFixed(1)} ${y.toFixed(1)}`;
        isBroken = false;
    });
    return (
        <svg class="spark" viewBox={`0 0 ${kWidth} ${kHeight}`} preserveAspectRatio="none" role="img" aria-label={label}>
            <path d={path} />
        </svg>
    );
}
