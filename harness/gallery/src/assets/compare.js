// Plots whose points choose pictures, a slider between two pictures, and the lightbox.
//
//   gallery.plotPoint(ladder, ms, error, label) a further point in a ladder's plots, for the visitor's own GPU
//   gallery.compare(ladder, {left, right})      the ladder's slider with these rungs
//   gallery.picture(name)                       the lightbox with the picture of that file name; null closes it
'use strict';

(() => {
  // site.js makes `gallery`; without it the pictures work all the same.
  const site = typeof gallery === 'undefined' ? (window.gallery = {}) : gallery;
  const SVG = 'http://www.w3.org/2000/svg';
  const all = (selector, place = document) => [...place.querySelectorAll(selector)];
  const say = (text) => site.say?.(text);

  /** Makes an element of an SVG. */
  const drawn = (name, attributes, text = '') => {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    return element;
  };

  /** Makes an element of HTML. */
  const made = (name, attributes, ...children) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };

  /** Sets a part of the address after `#`, or removes it, without an entry in the history. */
  const address = (hash) => history.replaceState(null, '', hash ? `#${hash}` : location.pathname + location.search);

  // ---- Plots -------------------------------------------------------------------------------------------------------

  /** A ten-pointed star about the origin: no series has it. */
  const STAR = Array.from({ length: 10 }, (_, k) => {
    const [angle, radius] = [(k * Math.PI) / 5, k % 2 ? 3.6 : 8.5];
    return `${k ? 'L' : 'M'}${(radius * Math.sin(angle)).toFixed(1)} ${(-radius * Math.cos(angle)).toFixed(1)}`;
  }).join('') + 'Z';

  /** The numbers that a plot carries: its ends in ms and in error, and the pixels of its area. */
  const scaleOf = (svg) => Object.fromEntries(['x0', 'x1', 'y0', 'y1', 'left', 'right', 'top', 'bottom']
    .map((name) => [name, Number(svg.dataset[name])]));

  const across = ({ x0, x1, left, right }, ms) => left + (Math.log(ms / x0) / Math.log(x1 / x0)) * (right - left);
  const up = ({ y0, y1, top, bottom }, error) => bottom + (Math.log(error / y0) / Math.log(y1 / y0)) * (top - bottom);

  /** Returns the labels of the axis that have room between these ends. The plot lists each with the most powers of ten. */
  const ticksOf = (svg, { x0, x1 }) => {
    const decades = Math.log10(x1 / x0);
    const all = svg.dataset.ticks.split(' ').map((tick) => tick.split(':'));
    return all.filter(([ms, most]) => ms >= x0 && ms <= x1 && decades <= most).map(([ms]) => ms);
  };

  /** Lays a plot's columns anew, between the ends that it now has. */
  const relabel = (svg, scale) => {
    const columns = all('.column', svg);
    const model = columns[0];
    const columnOf = (ms) => {
      const column = model.cloneNode(true);
      column.dataset.x = ms;
      column.querySelector('text').textContent = ms;
      return column;
    };
    model.parentNode.append(...ticksOf(svg, scale).map(columnOf));
    columns.forEach((column) => column.remove());
  };

  /** Heights at which a visitor's label is tried, beside its point. */
  const HEIGHTS = [-9, 20, -26, 37];

  /** Hides labels that stand on others; those of defaults stay, and a visitor's looks for a free height. */
  const thin = (svg) => {
    const taken = [];
    const rankOf = (label) => (label.closest('.default') ? 0 : label.closest('.visitor') ? 1 : 2);
    const isFree = (label) => {
      const { left, right, top, bottom } = label.getBoundingClientRect();
      return !taken.some((other) => left < other.right && other.left < right && top < other.bottom && other.top < bottom);
    };
    for (const label of all('.point .label', svg).sort((a, b) => rankOf(a) - rankOf(b))) {
      label.style.display = '';
      const rank = rankOf(label);
      if (rank === 1) {
        const free = HEIGHTS.find((y) => {
          label.setAttribute('y', y);
          return isFree(label);
        });
        if (free === undefined) label.setAttribute('y', HEIGHTS[0]);
      }
      const isHidden = rank === 2 && !isFree(label);
      if (!isHidden) taken.push(label.getBoundingClientRect());
      label.style.display = isHidden ? 'none' : '';
      const leader = label.parentNode.querySelector('.leader');
      if (leader) leader.style.display = label.style.display;
    }
  };

  /** Puts labels that would run out of the drawing on the other side of their points. */
  const turn = (svg, scale) => {
    const { width } = svg.viewBox.baseVal;
    for (const label of all('.point .label', svg)) {
      const x = across(scale, label.closest('.point').dataset.x);
      const [beside, length] = [Number(label.getAttribute('x')), label.getComputedTextLength()];
      const isOut = beside > 0 ? x + beside + length > width : x + beside - length < 0;
      if (!isOut) continue;
      label.setAttribute('x', -beside);
      label.setAttribute('text-anchor', beside > 0 ? 'end' : 'start');
      label.parentNode.querySelector('.leader')?.setAttribute('x2', -beside);
    }
  };

  /** Moves everything in a plot to where its scale now has it. */
  const relay = (svg, scale) => {
    for (const column of all('.column', svg)) column.setAttribute('transform', `translate(${across(scale, column.dataset.x)} 0)`);
    for (const point of all('.point', svg)) {
      const { x, y } = point.dataset;
      point.setAttribute('transform', `translate(${across(scale, x)} ${up(scale, y)})`);
    }
    const front = svg.querySelector('path.front');
    const steps = front.dataset.front.split(' ').filter(Boolean).map((pair) => pair.split(',').map(Number));
    if (steps.length > 0) {
      const path = steps.map(([ms, error]) => `H${across(scale, ms)}V${up(scale, error)}`).join('');
      front.setAttribute('d', `M${across(scale, steps[0][0])} ${scale.top}${path}H${scale.right}`);
    }
  };

  /** Adds the star to a plot's legend, once. */
  const explain = (svg) => {
    const legend = svg.closest('figure')?.querySelector('.legend');
    if (!legend || legend.querySelector('.of-visitor')) return;
    const swatch = drawn('svg', { class: 'swatch visitor', viewBox: '-9 -9 18 18', width: 16, height: 16, 'aria-hidden': 'true' });
    swatch.append(drawn('path', { class: 'mark', d: STAR }));
    legend.append(made('li', { class: 'of-visitor' }, swatch, ' on your GPU'));
  };

  /** Adds a point to one plot; a second one of the same label takes its place. */
  const plotted = (svg, ms, error, label) => {
    const place = svg.querySelector('.visitors');
    all('.visitor', place).filter((old) => old.dataset.label === label).forEach((old) => old.remove());
    const room = 1.35;
    const before = scaleOf(svg);
    const scale = { ...before, x0: ms < before.x0 ? ms / room : before.x0, x1: ms > before.x1 ? ms * room : before.x1 };
    const clamped = Math.min(Math.max(error, scale.y0), scale.y1);
    const point = drawn('g', { class: 'point visitor', 'data-x': ms, 'data-y': clamped, 'data-label': label });
    const toLeft = across(scale, ms) > (scale.left + scale.right) / 2;
    point.append(
      drawn('title', {}, `${label}: ${ms.toPrecision(3)} ms`),
      drawn('line', { class: 'drop', y2: scale.bottom - up(scale, clamped) }),
      drawn('path', { class: 'mark', d: STAR }),
      drawn('text', { class: 'label', x: toLeft ? -12 : 12, y: -9, 'text-anchor': toLeft ? 'end' : 'start' }, label),
    );
    place.append(point);
    explain(svg);
    if (scale.x0 !== before.x0 || scale.x1 !== before.x1) {
      Object.assign(svg.dataset, { x0: scale.x0, x1: scale.x1 });
      relabel(svg, scale);
    }
    relay(svg, scale);
    turn(svg, scale);
    thin(svg);
    return point;
  };

  /**
   * Adds a point to a ladder's plots of such pictures as a live page times, and shows one of them. `ms` is the time of
   * the picture that the plot's caption names; where it lies outside the axis, the axis grows. Returns the points.
   */
  site.plotPoint = (ladder, ms, error, label) => {
    if (!(ms > 0) || !(error > 0)) return [];
    const figures = all('figure.plot', ladder).filter((figure) => figure.querySelector('svg.plot[data-live]'));
    const choices = all('.plot-devices input', ladder);
    const of = ({ dataset }) => choices.find(({ value }) => value === dataset.device);
    if (!figures.some((figure) => of(figure).checked)) of(figures[0]).checked = true;
    return figures.flatMap((figure) => all('svg.plot', figure)).map((svg) => plotted(svg, ms, error, label));
  };

  /** Finds room for the labels of a plot that is shown: one that is hidden has none. */
  const shown = ({ target }) => {
    if (!target.matches('.plot-devices input')) return;
    for (const svg of all('svg.plot', target.closest('.ladder')).filter((svg) => svg.querySelector('.visitor'))) {
      turn(svg, scaleOf(svg));
      thin(svg);
    }
  };

  // ---- The slider --------------------------------------------------------------------------------------------------

  const SIDES = ['left', 'right'];

  class Compare {
    constructor(figure) {
      this.figure = figure;
      this.ladder = figure.dataset.ladder;
      this.wipe = figure.querySelector('.compare-wipe');
      this.gain = figure.querySelector('.compare-gain');
      this.difference = figure.querySelector('.compare-difference');
      this.choices = Object.fromEntries(SIDES.map((side) => [side, figure.querySelector(`select[data-side=${side}]`)]));
      figure.querySelector('.compare-controls').hidden = false;
      this.wipe.hidden = false;
      figure.classList.add('is-live');
      // The slider is over the pictures, which now are no links.
      for (const link of all('a.compare-side', figure)) link.tabIndex = -1;
      this.wipe.addEventListener('input', () => figure.style.setProperty('--wipe', this.wipe.value));
      for (const side of SIDES) this.choices[side].addEventListener('change', () => this.chosen());
      figure.querySelector('.compare-swap').addEventListener('click', () => this.swap());
      for (const control of [this.difference, this.gain]) control.addEventListener('change', () => this.subtract());
      this.mark();
    }

    /** Shows these rungs; a side that is left out stays. */
    show(rungs) {
      for (const side of SIDES) if (rungs[side] !== undefined) this.choices[side].value = rungs[side];
      this.chosen();
    }

    swap() {
      const { left, right } = this.choices;
      this.show({ left: right.value, right: left.value });
    }

    /** Brings pictures, captions, plot and address to what is chosen. */
    chosen() {
      for (const side of SIDES) {
        const [option] = this.choices[side].selectedOptions;
        if (!option) continue;
        const link = this.figure.querySelector(`.compare-side[data-side=${side}]`);
        link.href = option.dataset.src;
        link.querySelector('img').alt = option.dataset.alt;
        const told = this.figure.querySelector(`.compare-caption[data-side=${side}] .compare-told`);
        const model = all('template', this.figure).find((template) => template.dataset.rung === option.value);
        told.replaceChildren(model.content.cloneNode(true));
        all('.copy', told).forEach((button) => { button.hidden = false; });
      }
      this.mark();
      this.subtract();
      const { left, right } = this.choices;
      const held = location.hash.slice(1).split('=');
      // A live scene keeps its state there, which tells more.
      if (held.length === 1 || held[0] === 'compare') {
        address(`compare=${[this.ladder, left.value, right.value].map(encodeURIComponent).join(',')}`);
      }
      say(`${left.value} on the left, ${right.value} on the right`);
    }

    /** Marks the two rungs in the ladder's plots. */
    mark() {
      const shown = SIDES.map((side) => this.choices[side].value);
      for (const link of all('.point a')) {
        if (link.dataset.ladder === this.ladder) link.closest('.point').classList.toggle('is-shown', shown.includes(link.dataset.rung));
      }
    }

    /** Shows the difference, or no longer. */
    subtract() {
      const { checked } = this.difference;
      const options = SIDES.map((side) => this.choices[side].selectedOptions[0]);
      // The exact pictures have the reference's size and encoding. Where a rung lacks one, those to look at must do.
      const exact = checked && options.every((option) => option.dataset.exact);
      SIDES.forEach((side, at) => {
        const image = this.figure.querySelector(`.compare-side[data-side=${side}] img`);
        const source = exact ? options[at].dataset.exact : options[at].dataset.src;
        if (image.getAttribute('src') !== source) image.src = source;
      });
      this.figure.classList.toggle('is-difference', checked);
      this.figure.querySelector('.compare-times').classList.toggle('is-on', checked);
      this.figure.style.setProperty('--gain', this.gain.value);
      // What is shown has 8 bits: at most 255 steps, which the gain reaches sooner.
      const white = Math.ceil(255 / this.gain.value);
      const gain = this.gain.value === '1' ? 'as it is' : `${this.gain.value} times as bright`;
      const of = exact
        ? 'from both at the reference’s 256 × 256 pixels, without loss.'
        : 'from the pictures to look at, whose compression leaves a few steps of 255.';
      this.figure.querySelector('.compare-says').textContent = checked
        ? `Difference of red, green and blue, each by itself: absolute, of sRGB values as shown (not of linear light), ${gain}. ` +
          `Black: equal. A colour: these channels differ. Full brightness: by ${white} steps of 255${white < 255 ? ' or more' : ''}. Computed ${of}`
        : '';
    }
  }

  const compares = new Map();

  site.compare = (ladder, rungs) => compares.get(ladder)?.show(rungs);

  /** A point or a rung of a table: shows its picture in the ladder's slider instead of its file. */
  const choose = (event) => {
    const link = event.target.closest?.('a[data-rung]');
    const compare = compares.get(link?.dataset.ladder);
    if (!compare || event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    compare.show({ right: link.dataset.rung });
    const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
    compare.figure.scrollIntoView({ block: 'nearest', behavior: calm ? 'auto' : 'smooth' });
  };

  // ---- The lightbox ------------------------------------------------------------------------------------------------

  const nameOf = (link) => decodeURIComponent(link.pathname.split('/').pop().replace(/\.[^.]*$/, ''));

  /** How far a finger moves sideways to go on, in pixels. */
  const SWIPE = 40;

  const Lightbox = {
    place: 0,
    opener: null,
    before: '',

    /** The page's pictures, in order, each file once. */
    links() {
      const seen = new Set();
      return all('a.picture').filter((link) => !seen.has(link.href) && seen.add(link.href));
    },

    dialog() {
      if (this.made) return this.made;
      const button = (label, text, does) => {
        const element = made('button', { type: 'button', 'aria-label': label, title: label }, text);
        element.addEventListener('click', does);
        return element;
      };
      this.image = made('img', { alt: '' });
      this.count = made('span', { class: 'lightbox-place' });
      this.told = made('div', { class: 'lightbox-caption', 'aria-live': 'polite' });
      this.step = [button('Previous picture', '←', () => this.go(-1)), button('Next picture', '→', () => this.go(1))];
      const bar = made('div', { class: 'lightbox-bar' }, ...this.step, this.count, button('Close', '✕', () => this.made.close()));
      this.made = made('dialog', { class: 'lightbox', 'aria-label': 'Picture' },
        made('div', { class: 'lightbox-stage' }, this.image), made('div', { class: 'lightbox-told' }, bar, this.told));
      this.made.addEventListener('keydown', (event) => this.key(event));
      this.swipe(this.made.querySelector('.lightbox-stage'));
      this.made.addEventListener('close', () => this.closed());
      document.body.append(this.made);
      return this.made;
    },

    /** Opens the picture of a link. */
    open(link, opener) {
      const place = this.links().findIndex((other) => other.href === link.href);
      if (place < 0) return;
      this.place = place;
      this.opener = opener;
      // A live scene may keep its state there, which closing brings back.
      const hash = location.hash.slice(1);
      if (!hash.startsWith('picture=')) this.before = hash;
      const dialog = this.dialog();
      this.show();
      if (!dialog.open) dialog.showModal();
    },

    show() {
      const links = this.links();
      const link = links[this.place];
      const thumbnail = link.querySelector('img');
      // The small picture stands there until the large one has come.
      this.image.src = thumbnail?.currentSrc || link.href;
      this.image.alt = thumbnail?.alt ?? '';
      const large = new Image();
      large.onload = () => { if (this.links()[this.place] === link) this.image.src = link.href; };
      large.src = link.href;
      const caption = link.closest('figure')?.querySelector('figcaption')?.cloneNode(true);
      all('[id]', caption ?? made('div', {})).forEach((element) => element.removeAttribute('id'));
      this.told.replaceChildren(...(caption ? caption.childNodes : [made('p', {}, thumbnail?.alt ?? '')]),
        made('p', {}, made('a', { href: link.href }, 'The file')));
      this.count.textContent = `${this.place + 1} of ${links.length}`;
      this.step.forEach((button) => { button.disabled = links.length < 2; });
      address(`picture=${encodeURIComponent(nameOf(link))}`);
    },

    /** Goes on by so many pictures, around the end. */
    go(by) {
      const { length } = this.links();
      this.place = (this.place + by + length) % length;
      this.show();
    },

    key(event) {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (by === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      this.go(by);
    },

    /** Goes on by a finger that moves sideways; two enlarge the page, as ever. */
    swipe(stage) {
      let from = null;
      const only = ({ touches }) => (touches.length === 1 && (window.visualViewport?.scale ?? 1) < 1.01 ? touches[0] : null);
      stage.addEventListener('touchstart', (event) => { from = only(event); }, { passive: true });
      stage.addEventListener('touchend', ({ changedTouches: [to] }) => {
        if (!from) return;
        const [right, down] = [to.clientX - from.clientX, to.clientY - from.clientY];
        from = null;
        if (Math.abs(right) > SWIPE && Math.abs(right) > 2 * Math.abs(down)) this.go(right < 0 ? 1 : -1);
      });
    },

    closed() {
      this.opener?.focus();
      address(this.before);
      this.before = '';
    },
  };

  site.picture = (name) => {
    if (name === null) return Lightbox.made?.close();
    const link = Lightbox.links().find((other) => nameOf(other) === name);
    if (link) Lightbox.open(link, link);
  };

  const enlarge = (event) => {
    const link = event.target.closest?.('a.picture');
    if (!link || event.ctrlKey || event.metaKey || event.shiftKey || event.button !== 0) return;
    event.preventDefault();
    Lightbox.open(link, link);
  };

  /** Follows `#picture=NAME` and `#compare=LADDER,LEFT,RIGHT`. */
  const follow = () => {
    const [kind, value] = location.hash.slice(1).split('=');
    if (value === undefined) return;
    if (kind === 'picture') site.picture(decodeURIComponent(value));
    if (kind !== 'compare') return;
    const [ladder, left, right] = value.split(',').map(decodeURIComponent);
    const compare = compares.get(ladder);
    const knows = (rung) => compare && [...compare.choices.left.options].some((option) => option.value === rung);
    if (!knows(left) || !knows(right)) return;
    compare.show({ left, right });
    compare.figure.scrollIntoView({ block: 'center' });
  };

  const start = () => {
    for (const figure of all('figure.compare')) compares.set(figure.dataset.ladder, new Compare(figure));
    document.addEventListener('click', choose);
    document.addEventListener('change', shown);
    document.addEventListener('click', enlarge);
    addEventListener('hashchange', follow);
    follow();
  };
  if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', start);
  else start();
})();
