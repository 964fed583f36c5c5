// The token of the page. It arrives in the fragment of the address, and moves into the storage of this tab.

const kKey = 'mural-token';

// Returns the token of this tab, or an empty text. Removes it from the address and from the history entry.
export function takeToken(): string {
    const match = /^#t=([A-Za-z0-9_-]+)(?:&(.*))?$/.exec(location.hash);
    if (match) {
        sessionStorage.setItem(kKey, match[1]!);
        history.replaceState(null, '', location.pathname + location.search + (match[2] ? '#' + match[2] : '#wall'));
    }
    return sessionStorage.getItem(kKey) ?? '';
}

export function storeToken(token: string): void {
    sessionStorage.setItem(kKey, token);
}

export function forgetToken(): void {
    sessionStorage.removeItem(kKey);
}

// Returns the token in a pasted address, or the text itself.
export function tokenOf(text: string): string {
    const match = /#t=([A-Za-z0-9_-]+)/.exec(text);
    return match ? match[1]! : text.trim();
}

// Returns the address that opens this page with another token.
export function addressWith(token: string): string {
    return location.origin + location.pathname + '#t=' + token;
}
