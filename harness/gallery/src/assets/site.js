'use strict';
// What every page does: data on demand, copying, search, the menu, light and dark.

const gallery = (() => {
  const root = document.documentElement.dataset.root;
  const waiting = new Map();
  const status = () => document.getElementById('status');

  /** Loads a value by name: a script hands it over, which works from a file too. */
  function load(name) {
    if (!waiting.has(name)) {
      const entry = {};
      entry.promise = new Promise((resolve, reject) => Object.assign(entry, { resolve, reject }));
      waiting.set(name, entry);
      const script = document.createElement('script');
      script.src = `${root}data/${name.split('/').map(encodeURIComponent).join('/')}.js`;
      script.addEventListener('error', () => {
        waiting.delete(name);
        entry.reject(new Error(`data/${name}.js cannot be loaded; is the gallery's folder whole?`));
      });
      script.addEventListener('load', () => script.remove());
      document.head.append(script);
    }
    return waiting.get(name).promise;
  }

  /** Called by the scripts in data/. */
  function deliver(name, value) {
    waiting.get(name)?.resolve(value);
  }

  /** Loads bytes by name: base64 of gzip. */
  async function bytes(name) {
    const text = atob(await load(name));
    const packed = Uint8Array.from(text, (character) => character.charCodeAt(0));
    const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Response(unpacked).arrayBuffer();
  }

  /** Copies a text; false if the browser offers no way. */
  async function copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      return copyByCommand(text);
    }
  }

  // From file:// a browser may offer no clipboard, so the older way is tried.
  function copyByCommand(text) {
    const area = document.createElement('textarea');
    area.value = text;
    area.className = 'quiet';
    document.body.append(area);
    const focused = document.activeElement;
    area.select();
    let done = false;
    try {
      done = document.execCommand('copy');
    } catch {
      // Not offered either.
    }
    area.remove();
    focused?.focus();
    return done;
  }

  /** Says something to who listens instead of looking. */
  function say(text) {
    status().textContent = text;
  }

  return { root, load, deliver, bytes, copy, say };
})();
window.gallery = gallery;

// Copy buttons: the text of the code beside them, or of a source that is loaded then.
async function textOf(box) {
  return box.dataset.source ? gallery.load(box.dataset.source) : box.querySelector('code').textContent;
}

async function copyFrom(button) {
  const box = button.closest('.copyable');
  let done = false;
  try {
    done = await gallery.copy(await textOf(box));
  } catch (error) {
    gallery.say(error.message);
    button.textContent = 'Not loaded';
    return;
  }
  const code = box.querySelector('code');
  if (!done && code) {
    box.querySelector('details')?.setAttribute('open', '');
    getSelection().selectAllChildren(code);
  }
  const label = button.dataset.label ?? (button.dataset.label = button.textContent);
  button.textContent = done ? 'Copied' : 'Press Ctrl+C';
  button.classList.toggle('done', done);
  gallery.say(done ? 'Copied.' : 'The text is selected; copy it with the keyboard.');
  setTimeout(() => {
    button.textContent = label;
    button.classList.remove('done');
  }, 2000);
}

document.addEventListener('click', (event) => {
  const button = event.target.closest?.('button.copy');
  if (button?.closest('.copyable')) copyFrom(button);
});
for (const button of document.querySelectorAll('button[hidden]:is(.copy, .search-open, .theme, .menu)')) button.hidden = false;

// What scrolls sideways can be reached and scrolled with the keyboard; what does not is no stop for it.
function reachScrollers() {
  const usual = { tabindex: '0', role: 'group', 'aria-label': 'Scrolls' };
  for (const box of document.querySelectorAll('.scroll')) {
    const scrolls = box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1;
    // What the page itself wrote stays; the names of what is added here are kept on the element.
    const { reached } = box.dataset;
    if (scrolls && reached === undefined) {
      const lacking = Object.keys(usual).filter((name) => !box.hasAttribute(name));
      for (const name of lacking) box.setAttribute(name, usual[name]);
      box.dataset.reached = lacking.join(' ');
    } else if (!scrolls && reached !== undefined) {
      for (const name of reached.split(' ').filter(Boolean)) box.removeAttribute(name);
      delete box.dataset.reached;
    }
  }
}
// Layout is read when nothing else is waiting.
const whenIdle = window.requestIdleCallback ?? ((act) => setTimeout(act, 200));
addEventListener('load', () => whenIdle(reachScrollers));
addEventListener('resize', () => whenIdle(reachScrollers));
document.addEventListener('toggle', reachScrollers, true);

// A link to something within a fold opens it.
function unfold() {
  const name = decodeURIComponent(location.hash.slice(1));
  const target = name ? document.getElementById(name) : null;
  for (let fold = target?.closest('details'); fold; fold = fold.parentElement.closest('details')) fold.open = true;
  if (target?.tagName === 'DETAILS') target.open = true;
}
addEventListener('hashchange', unfold);
unfold();

// The menu on small screens.
const menu = document.querySelector('.menu');
menu.addEventListener('click', () => {
  const open = document.body.classList.toggle('menu-open');
  menu.setAttribute('aria-expanded', String(open));
  if (open) document.querySelector('#contents a').focus();
});
addEventListener('keydown', (event) => {
  if (event.key === 'Escape' && document.body.classList.contains('menu-open')) {
    menu.click();
    menu.focus();
  }
});
document.querySelector('#contents [aria-current]')?.scrollIntoView({ block: 'nearest' });

// Light and dark.
document.querySelector('.theme').addEventListener('click', () => {
  const shown = document.documentElement.dataset.theme ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
  const next = shown === 'dark' ? 'light' : 'dark';
  // The system's own is followed again.
  const own = (next === 'dark') === matchMedia('(prefers-color-scheme: dark)').matches;
  if (own) delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = next;
  try {
    if (own) localStorage.removeItem('lapidary-theme');
    else localStorage.setItem('lapidary-theme', next);
  } catch {
    // Kept for this page alone.
  }
  gallery.say(`${next} colours`);
});

// Search over functions, rungs, pages, headings and pictures.
const search = (() => {
  const MOST = 40;
  let dialog = null;
  let entries = [];
  let chosen = 0;

  function build() {
    dialog = document.createElement('dialog');
    dialog.className = 'search';
    dialog.setAttribute('aria-label', 'Search');
    const field = document.createElement('input');
    Object.assign(field, { type: 'search', placeholder: 'A function, a page, a word', autocomplete: 'off', spellcheck: false });
    for (const [name, value] of Object.entries({
      'aria-label': 'Search functions and pages',
      role: 'combobox',
      'aria-expanded': 'true',
      'aria-controls': 'found',
      'aria-autocomplete': 'list',
    })) {
      field.setAttribute(name, value);
    }
    const list = document.createElement('ul');
    list.id = 'found';
    list.setAttribute('role', 'listbox');
    list.setAttribute('aria-label', 'Found');
    const hint = document.createElement('p');
    hint.className = 'hint';
    dialog.append(field, list, hint);
    document.body.append(dialog);
    field.addEventListener('input', () => show(field.value));
    dialog.addEventListener('keydown', onKey);
    dialog.addEventListener('click', (event) => {
      if (event.target === dialog) dialog.close();
    });
  }

  /** How well an entry answers the words; 0 if one of them is not there, or, of `some`, if none is. */
  function score(entry, words, some) {
    const name = entry.name.toLowerCase();
    const all = `${name} ${entry.on} ${entry.text} ${entry.words ?? ''}`.toLowerCase();
    const weight = { page: 3, function: 2, rung: 2, picture: 0.5, heading: 1 }[entry.kind];
    let [sum, found] = [0, 0];
    for (const word of words) {
      if (!all.includes(word)) {
        if (some) continue;
        return 0;
      }
      found += 1;
      if (name === word) sum += 12;
      else if (name.startsWith(word)) sum += 6;
      else if (name.includes(word)) sum += 4;
      else sum += 1;
    }
    // More of the words go before a better place of one.
    return found && 1000 * found + sum * weight - name.length / 1000;
  }

  function show(text) {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const list = dialog.querySelector('#found');
    const answers = (some) => entries.map((entry) => [score(entry, words, some), entry]).filter(([points]) => points > 0);
    let scored = words.length ? answers(false) : [];
    const partial = words.length > 1 && !scored.length;
    if (partial) scored = answers(true);
    scored.sort((a, b) => b[0] - a[0]);
    list.replaceChildren(...scored.slice(0, MOST).map(([, entry], place) => option(entry, place)));
    const left = scored.length > MOST ? `${scored.length - MOST} more: a further word narrows it.` : '';
    const none = words.length === 1 ? 'Nothing has this word.' : 'Nothing has any of these words.';
    const some = partial ? 'Nothing has all of these words; these have some. ' : '';
    dialog.querySelector('.hint').textContent = words.length && !scored.length ? none : some + left;
    choose(0);
  }

  function option(entry, place) {
    const item = document.createElement('li');
    item.id = `found-${place}`;
    item.setAttribute('role', 'option');
    const link = document.createElement('a');
    link.href = gallery.root + entry.path;
    link.tabIndex = -1;
    const name = document.createElement(['function', 'rung'].includes(entry.kind) ? 'code' : 'b');
    name.textContent = entry.name;
    const on = document.createElement('span');
    on.textContent = entry.on || entry.kind;
    const text = document.createElement('small');
    text.textContent = entry.text;
    link.append(name, on, text);
    link.addEventListener('click', () => dialog.close());
    item.append(link);
    return item;
  }

  function choose(place) {
    const items = [...dialog.querySelectorAll('#found > li')];
    chosen = Math.max(0, Math.min(place, items.length - 1));
    items.forEach((item, at) => item.setAttribute('aria-selected', String(at === chosen)));
    const field = dialog.querySelector('input');
    if (items.length) field.setAttribute('aria-activedescendant', `found-${chosen}`);
    else field.removeAttribute('aria-activedescendant');
    items[chosen]?.scrollIntoView({ block: 'nearest' });
  }

  function onKey(event) {
    if (event.key === 'ArrowDown') choose(chosen + 1);
    else if (event.key === 'ArrowUp') choose(chosen - 1);
    else if (event.key === 'Escape') dialog.close();
    else if (event.key === 'Enter') dialog.querySelector(`#found-${chosen} a`)?.click();
    else return;
    event.preventDefault();
  }

  async function open() {
    if (!dialog) build();
    dialog.showModal();
    const field = dialog.querySelector('input');
    field.select();
    try {
      entries = await gallery.load('search');
      show(field.value);
    } catch (error) {
      dialog.querySelector('.hint').textContent = error.message;
    }
  }

  document.querySelector('.search-open').addEventListener('click', open);
  addEventListener('keydown', (event) => {
    const typing = event.target.closest?.('input:not([type="checkbox"], [type="range"], [type="file"]), textarea, select');
    const asked = (event.key === '/' && !typing) || (event.key === 'k' && (event.ctrlKey || event.metaKey));
    if (!asked || document.querySelector('dialog[open]')) return;
    event.preventDefault();
    open();
  });
  return { open };
})();
gallery.search = search.open;
