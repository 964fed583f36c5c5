// Properties of every view.

import type { Session } from '../session/session.ts';

export interface ViewProps {
    session: Session;
    // Opens the drawer of a node.
    openNode(node: number): void;
}
