// The editor of "Edit this function and check it": shows a module's text, and what gallery.check says about it.
'use strict';

(() => {
  /** An element with a class and contents. */
  function made(tag, name, ...contents) {
    const element = document.createElement(tag);
    if (name) element.className = name;
    element.append(...contents);
    return element;
  }

  /** A list of terms and what they are. */
  function terms(pairs) {
    const list = made('dl', 'check-terms');
    for (const [term, ...texts] of pairs) {
      list.append(made('dt', '', term), ...texts.map((text) => made('dd', '', text)));
    }
    return list;
  }

  const code = (text) => made('code', '', text);

  /** A module without comments and with single spaces: a line of WGSL has more ends than \n, and comments nest. */
  function stripped(module) {
    let [text, at, depth] = ['', 0, 0];
    while (at < module.length) {
      const mark = depth > 0 ? /\/\*|\*\//g : /\/\*|\/\/[^\n\v\f\r\x85\u2028\u2029]*/g;
      mark.lastIndex = at;
      const [found] = mark.exec(module) ?? [''];
      const end = found ? mark.lastIndex : module.length;
      if (depth === 0) text += `${module.slice(at, end - found.length)} `;
      if (found === '/*') depth += 1;
      if (found === '*/') depth -= 1;
      at = end;
    }
    return text.replace(/[\t-\r \x85\u200e\u200f\u2028\u2029]+/g, ' ');
  }

  /** A module's declarations by name, without comments and with single spaces. */
  function declared(module) {
    const bare = stripped(module);
    const found = new Map();
    let [depth, from] = [0, 0];
    for (let at = 0; at < bare.length; at++) {
      if (bare[at] === '{') depth += 1;
      if (bare[at] === '}') depth = Math.max(0, depth - 1);
      if (depth > 0 || !'};'.includes(bare[at])) continue;
      const text = bare.slice(from, at + 1).trim();
      const name = /(?:(?:fn|const|override|struct|alias|var) |var ?<[^>]*> ?)([\p{XID_Start}_]\p{XID_Continue}*)/u.exec(text)?.[1];
      if (name) found.set(name, text);
      from = at + 1;
    }
    return found;
  }

  /** Names of a declaration and of all that it needs. */
  function needed(name, all) {
    const seen = new Set(all.has(name) ? [name] : []);
    // The loop comes to what it adds as well.
    for (const each of seen) {
      // Neither a number's suffix nor a member is a declaration's name.
      for (const [word] of all.get(each).matchAll(/(?<![.\p{XID_Continue}])[\p{XID_Start}_]\p{XID_Continue}*/gu)) {
        if (all.has(word)) seen.add(word);
      }
    }
    return seen;
  }

  /** A declaration's text with all that it needs. */
  const whole = (name, all) => [...needed(name, all)].sort().map((of) => all.get(of)).join('\n');

  /** Names in a row: `a, b and c`. */
  const row = (names) => names.join(', ').replace(/, (?=[^,]*$)/, ' and ');

  class Editor {
    /** What held in a check: the text of each function, with all that it needs. */
    held = new Map();

    constructor(root) {
      this.root = root;
      this.module = root.dataset.module;
      const part = (name) => root.querySelector(`.check-${name}`);
      for (const name of ['function', 'open', 'bound', 'editor', 'lines', 'text', 'run', 'restore', 'copy', 'result']) {
        this[name] = part(name);
      }
      this.function.addEventListener('change', () => this.turn());
      this.open.addEventListener('click', () => this.toggle());
      this.run.addEventListener('click', () => this.check());
      this.restore.addEventListener('click', () => this.reset());
      this.copy.addEventListener('click', () => this.hand());
      this.text.addEventListener('input', () => {
        // What was found is of another text now.
        this.number([]);
        this.result.replaceChildren();
      });
      this.text.addEventListener('scroll', () => (this.lines.scrollTop = this.text.scrollTop));
      this.text.addEventListener('keydown', (event) => {
        if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
        event.preventDefault();
        this.check();
      });
      this.turn();
    }

    get name() {
      return this.function.value;
    }

    /** Another function is chosen. */
    turn() {
      const { accuracy } = this.function.selectedOptions[0].dataset;
      this.bound.replaceChildren('Its bound on any GPU: ', code(accuracy));
      this.result.replaceChildren();
      if (!this.editor.hidden) this.show();
    }

    async toggle() {
      if (this.editor.hidden) return this.begin(this.name);
      this.editor.hidden = true;
      // Its buttons lead into the text.
      this.result.replaceChildren();
      this.open.setAttribute('aria-expanded', 'false');
      this.open.textContent = 'Open the editor';
    }

    /** Opens the editor at a function. */
    async begin(name) {
      this.function.value = name;
      try {
        this.original ??= await gallery.load(`source/${this.module}`);
        this.declared ??= declared(this.original);
      } catch (error) {
        return this.fail(error);
      }
      if (this.text.value === '') this.text.value = this.original;
      this.editor.hidden = false;
      this.open.setAttribute('aria-expanded', 'true');
      this.open.textContent = 'Close the editor';
      this.number([]);
      this.turn();
      this.text.focus({ preventScroll: true });
      this.root.scrollIntoView({ block: 'nearest' });
    }

    /** Brings the function's lines into view, with the caret at its name. */
    show() {
      const found = this.text.value.search(new RegExp(`^fn\\s+${this.name}\\b`, 'm'));
      if (found < 0) return;
      this.text.setSelectionRange(found, found);
      this.scroll(this.text.value.slice(0, found).split('\n').length - 3);
    }

    scroll(line) {
      this.text.scrollTop = Math.max(0, line) * this.lineHeight;
      this.text.scrollLeft = 0;
    }

    get lineHeight() {
      return parseFloat(getComputedStyle(this.text).lineHeight);
    }

    /** Numbers the lines, and marks those of errors. */
    number(marked) {
      const count = this.text.value.split('\n').length;
      if (this.lines.childElementCount !== count || marked.length > 0 || this.marked) {
        const lines = Array.from({ length: count }, (_, at) => made('span', marked.includes(at + 1) ? 'check-wrong' : '', `${at + 1}`));
        this.lines.replaceChildren(...lines);
      }
      this.marked = marked.length > 0;
      this.text.setAttribute('aria-invalid', String(this.marked));
      const band = 'linear-gradient(var(--check-mark), var(--check-mark))';
      const padding = parseFloat(getComputedStyle(this.text).paddingTop);
      const style = (values) => marked.map(values).join(', ');
      this.text.style.backgroundImage = style(() => band);
      this.text.style.backgroundPosition = style((line) => `0 ${padding + (line - 1) * this.lineHeight}px`);
      this.text.style.backgroundSize = style(() => `100% ${this.lineHeight}px`);
      this.lines.scrollTop = this.text.scrollTop;
    }

    reset() {
      this.text.value = this.original;
      this.number([]);
      this.result.replaceChildren();
      this.show();
      gallery.say('The module is as it was.');
    }

    async hand() {
      const done = await gallery.copy(this.text.value);
      this.copy.textContent = done ? 'Copied' : 'Not copied';
      setTimeout(() => (this.copy.textContent = 'Copy'), 2000);
    }

    async check() {
      this.result.replaceChildren(made('p', 'dim', `Checking ${this.name} …`));
      this.waits = this.busy;
      if (this.waits) return;
      this.busy = true;
      this.run.setAttribute('aria-disabled', 'true');
      const [name, text] = [this.name, this.text.value];
      // The visitor may turn to another function, change the text or close the editor meanwhile.
      const asked = () => name === this.name && text === this.text.value && !this.editor.hidden;
      try {
        const found = await gallery.check(name, text);
        const now = declared(text);
        if (found.held === found.rows) this.held.set(name, whole(name, now));
        if (asked()) this.report(name, now, found);
      } catch (error) {
        if (asked()) this.fail(error);
      } finally {
        this.busy = false;
        this.run.removeAttribute('aria-disabled');
      }
      // A press during this check was about something else.
      if (this.waits && !asked() && !this.editor.hidden) this.check();
    }

    fail(error) {
      this.tell(made('p', 'check-fails', error.message || String(error)));
    }

    /** Shows a result, whose leading paragraphs are also said. */
    tell(...parts) {
      this.result.replaceChildren(...parts);
      const others = parts.findIndex((part) => part.tagName !== 'P');
      gallery.say(parts.slice(0, others < 0 ? undefined : others).map((part) => part.dataset.said ?? part.textContent).join(' '));
      // By Ctrl+Enter it may come below the window; who has gone on meanwhile is not pulled back.
      const { top, bottom } = this.root.getBoundingClientRect();
      const here = this.root.contains(document.activeElement) && top < innerHeight && bottom > 0;
      if (here) this.result.scrollIntoView({ block: 'nearest' });
    }

    /** What is changed and did not hold in a check of its own, as paragraphs: a check runs one function of the text. */
    unchecked(name, now) {
      const before = this.declared;
      const offered = Array.from(this.function.options, ({ value }) => value);
      const open = offered.filter((of) => of !== name && whole(of, now) !== whole(of, before) && this.held.get(of) !== whole(of, now));
      const [direct, through] = [true, false].map((is) => open.filter((of) => (now.get(of) !== before.get(of)) === is));
      const reached = new Set(offered.flatMap((of) => [...needed(of, now), ...needed(of, before)]));
      const none = [...before.keys()].filter((of) => !reached.has(of) && now.get(of) !== before.get(of));
      const said = (names, one, more) => (names.length > 0 ? [this.left(names, `${row(names)} ${names.length > 1 ? more : one}`)] : []);
      const changed = whole(name, now) === whole(name, before) ? 'changed' : 'changed too';
      const found = [
        ...said(direct, `is ${changed}, but not checked: choose it to check it.`, `are ${changed}, but not checked: choose each to check it.`),
        ...said(through, 'uses what is changed, and is not checked: choose it to check it.', 'use what is changed, and are not checked: choose each to check it.'),
      ];
      if (none.length > 0) found.push(made('p', 'check-left', `${row(none)} ${none.length > 1 ? 'are' : 'is'} ${changed}, and no function that is checked here uses ${none.length > 1 ? 'them' : 'it'}.`));
      return found;
    }

    /** A sentence about functions that are left, with a button that checks each. */
    left(names, sentence) {
      const paragraph = made('p', 'check-left', sentence);
      paragraph.dataset.said = sentence;
      for (const name of names) {
        const go = made('button', 'check-line', `Check ${name}`);
        go.type = 'button';
        go.addEventListener('click', () => {
          this.function.value = name;
          this.turn();
          // This button is gone by now.
          this.run.focus({ preventScroll: true });
          this.check();
        });
        paragraph.append(' ', go);
      }
      return paragraph;
    }

    report(name, now, { rows, held, worst, messages, adapter }) {
      const errors = messages.filter(({ type }) => type === 'error');
      this.number([...new Set(errors.map(({ line }) => line).filter(Boolean))]);
      const said = messages.length > 0 ? [this.listed(messages)] : [];
      if (!worst) {
        this.tell(made('p', 'check-fails', 'It does not compile; your browser says:'), ...said);
        return;
      }
      const all = held === rows;
      const left = this.unchecked(name, now);
      if (!all) {
        const fails = `${rows - held} of ${rows} rows fail for ${name} on ${adapter}; ${held === 0 ? 'none holds' : `${held} ${held === 1 ? 'holds' : 'hold'}`}.`;
        return this.tell(made('p', 'check-fails', fails), ...left, ...said, this.worst(worst));
      }
      const same = left.length > 0 && whole(name, now) === whole(name, this.declared) ? ' It is as in the cookbook.' : '';
      const holds = made('p', 'check-holds', `All ${rows} rows hold for ${name} on ${adapter}.${same}`);
      // First what the rows say nothing about, so that it does not read as if all held.
      this.tell(...left, holds, ...said, this.worst(worst));
    }

    /** The compiler's messages; each leads to its line. */
    listed(messages) {
      const list = made('ul', 'check-messages');
      for (const { type, line, column, text } of messages) {
        const item = made('li', `check-${type}`);
        if (line) {
          const go = made('button', 'check-line', `Line ${line}`);
          go.type = 'button';
          go.addEventListener('click', () => this.go(line, column));
          item.append(go, ' ');
        }
        item.append(`${type}: ${text}`);
        list.append(item);
      }
      return list;
    }

    go(line, column) {
      const start = this.text.value.split('\n').slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
      const place = start + Math.max(0, column - 1);
      this.text.focus();
      this.text.setSelectionRange(place, place);
      this.scroll(line - 4);
    }

    worst({ label, holds, inputs, parts }) {
      const title = made('p', 'check-worst', `${holds ? 'The nearest to its bound' : 'The worst'}, ${label}:`);
      const result = parts.map(({ name, expected, got, error, bound, allowed, holds: right }) => {
        const rows = [['expected', code(expected)], ['got', code(got)], ['error', error], ['tolerance', `${bound}: here ${allowed}`]];
        const part = made('div', right ? 'check-part' : 'check-part check-broken');
        if (name) part.append(made('h3', '', code(name), right ? '' : ' does not hold'));
        part.append(terms(rows));
        return part;
      });
      const given = made('div', 'check-part', made('h3', '', 'Inputs'), terms(inputs.map(({ name, text }) => [code(name), code(text)])));
      return made('div', 'check-row', title, given, ...result);
    }
  }

  const start = () => {
    const editors = Array.from(document.querySelectorAll('.check[data-module]'), (root) => new Editor(root));
    // Elsewhere on the page: <a href="#edit-and-check" data-check="FUNCTION">.
    document.addEventListener('click', (event) => {
      // Such a click opens the link elsewhere.
      if (event.ctrlKey || event.metaKey || event.shiftKey || event.altKey) return;
      const link = event.target.closest?.('a[data-check]');
      const name = link?.dataset.check;
      const editor = editors.find(({ function: { options } }) => Array.from(options).some(({ value }) => value === name));
      if (!editor) return;
      // Following the link would take the focus from the text; a step back still leads to where it was clicked.
      event.preventDefault();
      if (location.hash !== link.hash) history.pushState(null, '', link.hash);
      editor.open.focus();
      editor.begin(name);
    });
  };
  if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', start);
  else start();
})();
