// Saves a document of the server as a file of the viewer.

import type { Session } from '../session/session.ts';

export async function saveDocument(session: Session, path: string, name: string): Promise<void> {
    try {
        const response = await session.fetch(path);
        saveBlob(await response.blob(), name);
    } catch (error) {
        session.notify('error', error instanceof Error ? error.message : String(error));
    }
}

export function saveBlob(blob: Blob, name: string): void {
    const address = URL.createObjectURL(blob);
    const link = document.createElement('a');
    link.href = address;
    link.download = name;
    link.click();
    // The browser begins to read the address after this turn.
    setTimeout(() => URL.revokeObjectURL(address), 10000);
}
