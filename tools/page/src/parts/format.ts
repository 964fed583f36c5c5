// Numbers as text. Pure.

export const kNone = '–';

export function count(value: number | null | undefined): string {
    return value === null || value === undefined || !Number.isFinite(value) ? kNone : Math.round(value).toLocaleString('en-US');
}

// Returns a number with about three digits.
export function short(value: number | null | undefined): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
    const size = Math.abs(value);
    return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : 2);
}

export function ms(value: number | null | undefined): string {
    return value === null || value === undefined || !Number.isFinite(value) ? kNone : `${short(value)} ms`;
}

export function bytes(value: number | null | undefined): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
    const units = ['B', 'kB', 'MB', 'GB', 'TB'];
    let unit = 0;
    for (; Math.abs(value) >= 1000 && unit + 1 < units.length; ++unit) value /= 1000;
    return `${unit === 0 ? Math.round(value) : short(value)} ${units[unit]}`;
}

export function byteRate(value: number | null | undefined): string {
    const text = bytes(value);
    return text === kNone ? text : `${text}/s`;
}

export function percent(value: number | null | undefined): string {
    return value === null || value === undefined || !Number.isFinite(value) ? kNone : `${Math.round(value * 100)} %`;
}

export function duration(seconds: number | null | undefined): string {
    if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return kNone;
    if (seconds < 1) return `${seconds.toFixed(1)} s`;
    if (seconds < 90) return `${Math.round(seconds)} s`;
    if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
    if (seconds < 129600) return `${Math.round(seconds / 3600)} h`;
    return `${Math.round(seconds / 86400)} d`;
}
