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

  class Editor {
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
      this.open.setAttribute('aria-expanded', 'false');
      this.open.textContent = 'Open the editor';
    }

    /** Opens the editor at a function. */
    async begin(name) {
      this.function.value = name;
      try {
        this.original ??= await gallery.load(`source/${this.module}`);
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
      if (this.busy) return;
      this.busy = true;
      this.run.setAttribute('aria-disabled', 'true');
      this.result.replaceChildren(made('p', 'dim', `Checking ${this.name} …`));
      const [name, text] = [this.name, this.text.value];
      try {
        const found = await gallery.check(name, text);
        // The visitor may have turned to another function meanwhile.
        if (name === this.name) this.report(name, found);
      } catch (error) {
        this.fail(error);
      } finally {
        this.busy = false;
        this.run.removeAttribute('aria-disabled');
      }
    }

    fail(error) {
      this.tell(made('p', 'check-fails', error.message || String(error)));
    }

    /** Shows a result, whose first line is also said. */
    tell(...parts) {
      this.result.replaceChildren(...parts);
      gallery.say(parts[0].textContent);
    }

    report(name, { rows, held, worst, messages, adapter }) {
      const errors = messages.filter(({ type }) => type === 'error');
      this.number([...new Set(errors.map(({ line }) => line).filter(Boolean))]);
      const said = messages.length > 0 ? [this.listed(messages)] : [];
      if (!worst) {
        this.tell(made('p', 'check-fails', 'It does not compile; your browser says:'), ...said);
        return;
      }
      const all = held === rows;
      const head = made('p', all ? 'check-holds' : 'check-fails');
      head.append(`${all ? 'All' : held} ${all ? '' : 'of '}${rows} rows hold`, ` for ${name} on ${adapter}.`);
      this.tell(head, ...said, this.worst(worst));
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
    // Elsewhere on the page: <button data-check="FUNCTION">.
    document.addEventListener('click', (event) => {
      const name = event.target.closest?.('[data-check]')?.dataset.check;
      const editor = editors.find(({ function: { options } }) => Array.from(options).some(({ value }) => value === name));
      if (name && editor) editor.begin(name);
    });
  };
  if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', start);
  else start();
})();
