// Links to this page: their list, new ones with a QR code, and their revocation.

import { useEffect, useMemo, useState } from 'preact/hooks';
import qrcode from 'qrcode-generator';
import { ConfirmButton } from '../parts/confirm_button.tsx';
import { duration } from '../parts/format.ts';
import { Table } from '../parts/table.tsx';
import { useCell } from '../session/cell.ts';
import { addressWith } from '../wire/token.ts';
import type { Link, Role } from '../wire/types.ts';
import type { ViewProps } from './view.ts';

const kRoles: [Role, string][] = [['view', 'see the wall'], ['input', 'see and use the program'], ['operate', 'everything']];
const kTimes: [number, string][] = [[3600, '1 hour'], [8 * 3600, '8 hours'], [7 * 86400, '7 days'], [0, 'as long as the page']];

function QrCode({ text }: { text: string }) {
    const { path, size } = useMemo(() => {
        const code = qrcode(0, 'M');
        code.addData(text);
        code.make();
        const count = code.getModuleCount();
        let path = '';
        for (let y = 0; y < count; ++y) for (let x = 0; x < count; ++x) if (code.isDark(y, x)) path += `M${x + 4} ${y + 4}h1v1h-1z`;
        return { path, size: count + 8 };
    }, [text]);
    return (
        <svg class="qr" viewBox={`0 0 ${size} ${size}`} role="img" aria-label="QR code of the new link" shape-rendering="crispEdges">
            <rect width={size} height={size} fill="#fff" /><path d={path} fill="#000" />
        </svg>
    );
}

function NewLink({ address, onClose, onCopy }: { address: string; onClose(): void; onCopy(): void }) {
    return (
        <div class="new-link" role="status">
            <QrCode text={address} />
            <div>
                <p><b>This link appears only once.</b> The list below never shows its secret part.</p>
                <input readOnly aria-label="Address of the new link" value={address} onFocus={event => event.currentTarget.select()} />
                <div class="buttons">
                    {navigator.clipboard && <button type="button" onClick={onCopy}>Copy</button>}
                    <button type="button" onClick={onClose}>Done</button>
                </div>
            </div>
        </div>
    );
}

// The reply is the list itself or an object with it.
function linksOf(result: unknown): Link[] {
    if (Array.isArray(result)) return result as Link[];
    const { links } = result as { links?: Link[] };
    return Array.isArray(links) ? links : [];
}

export function LinksView({ session }: ViewProps) {
    const viewers = useCell(session.viewers);
    const [links, setLinks] = useState<Link[] | null>(null);
    const [role, setRole] = useState<Role>('view');
    const [seconds, setSeconds] = useState(8 * 3600);
    const [most, setMost] = useState(20);
    const [name, setName] = useState('');
    const [address, setAddress] = useState('');
    const load = () => session.request('links').then(result => setLinks(linksOf(result))).catch(() => setLinks([]));
    useEffect(() => { if (session.may('operate')) void load(); }, [session, viewers]);
    if (!session.may('operate')) return <p class="empty">This link does not manage links.</p>;
    const create = async (event: Event) => {
        event.preventDefault();
        const link = await session.perform<{ token: string; address?: string }>('link-new', { role, seconds, most, name });
        if (link) setAddress(link.address ?? addressWith(link.token));
        void load();
    };
    const copy = () => navigator.clipboard.writeText(address)
        .then(() => session.notify('info', 'The address is in the clipboard.'), () => session.notify('error', 'The browser refuses the clipboard.'));
    const revoke = async (link: Link) => {
        await session.perform('link-revoke', { link: link.link }, 'The link is revoked, and its pages close.');
        void load();
    };
    return (
        <>
            <form class="card new" onSubmit={create}>
                <h2>New link</h2>
                <div class="parameters">
                    <label class="row">may
                        <select value={role} onChange={event => setRole(event.currentTarget.value as Role)}>
                            {kRoles.map(([value, text]) => <option key={value} value={value}>{text}</option>)}
                        </select></label>
                    <label class="row">valid for
                        <select value={seconds} onChange={event => setSeconds(Number(event.currentTarget.value))}>
                            {kTimes.map(([value, text]) => <option key={value} value={value}>{text}</option>)}
                        </select></label>
                    <label class="row">pages at once
                        <input type="number" min="1" max="64" value={most} onInput={event => setMost(Math.round(event.currentTarget.valueAsNumber) || 1)} /></label>
                    <label class="row">name
                        <input value={name} maxLength={40} placeholder="class, visitors, …" autocomplete="off" onInput={event => setName(event.currentTarget.value)} /></label>
                </div>
                <div class="buttons"><button class="primary">Create link</button></div>
                {address && <NewLink address={address} onClose={() => setAddress('')} onCopy={copy} />}
            </form>
            <Table caption="Links" rows={links ?? []} keyOf={link => link.link} empty={links ? 'No links.' : 'Loading.'}
                columns={[
                    { name: 'Link', key: link => link.link, show: link => `#${link.link}` },
                    { name: 'Name', key: link => link.name, show: link => link.name || '–' },
                    { name: 'May', key: link => link.role, show: link => kRoles.find(([value]) => value === link.role)?.[1] ?? link.role },
                    { name: 'Expires', isNumber: true, key: link => link.secondsLeft ?? Infinity,
                        show: link => (link.secondsLeft === null ? 'with the page' : `in ${duration(link.secondsLeft)}`) },
                    { name: 'Open', isNumber: true, key: link => link.open, show: link => `${link.open}${link.most ? ` of ${link.most}` : ''}` },
                    { name: 'Revoke', show: link => <ConfirmButton question="Close its pages" onConfirm={() => void revoke(link)}>Revoke</ConfirmButton> },
                ]} />
            <h2>Open pages</h2>
            <Table caption="Open pages" rows={viewers} keyOf={viewer => viewer.client} empty="No pages."
                columns={[
                    { name: 'Viewer', key: viewer => viewer.client, show: viewer => `#${viewer.client}${viewer.client === session.self?.client ? ' (this page)' : ''}` },
                    { name: 'Name', key: viewer => viewer.name, show: viewer => viewer.name || '–' },
                    { name: 'May', key: viewer => viewer.role, show: viewer => viewer.role },
                    { name: 'Control', key: viewer => Number(viewer.holder), show: viewer => (viewer.holder ? 'has control' : '–') },
                ]} />
        </>
    );
}
