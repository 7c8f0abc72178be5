// What is compared, from techniques.json.

import { readFileSync } from 'node:fs';

const text = readFileSync(new URL('techniques.json', import.meta.url), 'utf8');

/**
 * The scene, the views and the techniques of both sides; and `straight`, drei's without a stone:
 * with index 1 and no bounces a ray passes straight into the environment.
 */
export const { scene, views, straight, drei, lapidary } = JSON.parse(text);

/** Names of all techniques, drei's first. */
export const names = [...drei.map((technique) => technique.name), ...lapidary];
