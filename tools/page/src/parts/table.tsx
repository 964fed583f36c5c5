// A table whose columns sort by a click on their heads.

import { useState } from 'preact/hooks';
import type { ComponentChildren } from 'preact';

export interface Column<Row> {
    name: string;
    // Key of the order; missing: the column does not sort.
    key?(row: Row): number | string;
    show(row: Row): ComponentChildren;
    isNumber?: boolean;
    hint?: string;
}

interface Props<Row> {
    caption: string;
    columns: Column<Row>[];
    rows: Row[];
    keyOf(row: Row): string | number;
    empty: string;
}

export function Table<Row>({ caption, columns, rows, keyOf, empty }: Props<Row>) {
    const [order, setOrder] = useState<{ name: string; isDown: boolean } | null>(null);
    const column = columns.find(entry => entry.name === order?.name);
    const sorted = [...rows];
    if (column?.key && order) {
        const sign = order.isDown ? -1 : 1;
        sorted.sort((a, b) => {
            const [p, q] = [column.key!(a), column.key!(b)];
            return sign * (typeof p === 'string' || typeof q === 'string' ? String(p).localeCompare(String(q)) : (p || 0) - (q || 0));
        });
    }
    if (!rows.length) return <p class="empty">{empty}</p>;
    const sort = (name: string) => setOrder({ name, isDown: order?.name === name ? !order.isDown : false });
    return (
        <div class="scroll" tabIndex={0} role="region" aria-label={caption}>
            <table>
                <caption class="hidden">{caption}</caption>
                <thead>
                    <tr>
                        {columns.map(({ name, key, isNumber, hint }) => (
                            <th key={name} scope="col" class={isNumber ? 'number' : ''} title={hint}
                                aria-sort={order?.name !== name ? undefined : order.isDown ? 'descending' : 'ascending'}>
                                {key ? (
                                    <button class="sort" onClick={() => sort(name)}>
                                        {name}
                                        <span aria-hidden="true">{order?.name !== name ? '' : order.isDown ? ' ▾' : ' ▴'}</span>
                                    </button>
                                ) : name}
                            </th>
                        ))}
                    </tr>
                </thead>
                <tbody>
                    {sorted.map(row => (
                        <tr key={keyOf(row)}>
                            {columns.map(({ name, show, isNumber }) => <td key={name} class={isNumber ? 'number' : ''}>{show(row)}</td>)}
                        </tr>
                    ))}
                </tbody>
            </table>
        </div>
    );
}
