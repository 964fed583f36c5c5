// A drawing of the server as elements of the page. Only shapes and their attributes pass; scripts, links and styles do not.

import { useEffect, useRef } from 'preact/hooks';

const kElements = new Set(['svg', 'g', 'rect', 'line', 'path', 'polyline', 'polygon', 'circle', 'ellipse', 'text', 'tspan', 'title', 'desc']);
const kAttribute = /^(x|y|x1|y1|x2|y2|cx|cy|r|rx|ry|d|points|width|height|viewBox|transform|fill|stroke|opacity|dx|dy|(?:fill|stroke|font|text|letter)-[a-z-]+)$/;
const kNamespace = 'http://www.w3.org/2000/svg';

function copyOf(source: Element): SVGElement | null {
    if (!kElements.has(source.localName)) return null;
    const copy = document.createElementNS(kNamespace, source.localName);
    for (const { name, value } of source.attributes)
        if (kAttribute.test(name) && !/url\s*\(/i.test(value)) copy.setAttribute(name, value);
    for (const child of source.childNodes) {
        if (child.nodeType === Node.TEXT_NODE) copy.append(child.textContent ?? '');
        else if (child instanceof Element) {
            const inner = copyOf(child);
            if (inner) copy.append(inner);
        }
    }
    return copy;
}

export function SafeSvg({ text, label }: { text: string; label: string }) {
    const place = useRef<HTMLDivElement>(null);
    useEffect(() => {
        const source = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
        const copy = source.localName === 'svg' ? copyOf(source) : null;
        if (copy) {
            copy.setAttribute('role', 'img');
            copy.setAttribute('aria-label', label);
        }
        place.current!.replaceChildren(...(copy ? [copy] : []));
    }, [text, label]);
    return <div ref={place} class="drawing" />;
}
