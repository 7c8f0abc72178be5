// Starts the measurement (?measure) or the page to look at.

import { look } from './look.js';
import { measure } from './measure.js';

const list = await (await fetch('/list.json')).json();
const measuring = new URLSearchParams(location.search).has('measure');
try {
  await (measuring ? measure(list) : look(list));
} catch (error) {
  document.querySelector('#note').textContent = error.message;
  if (measuring) await fetch('/failed', { method: 'POST', body: error.stack ?? String(error) });
}
