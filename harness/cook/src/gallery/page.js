"use strict";

// Copying. From file:// a browser may offer no clipboard, so the older way is tried, and then the text is selected.
const status = document.getElementById("status");

async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    area.className = "quiet";
    document.body.append(area);
    const focused = document.activeElement;
    area.select();
    let done = false;
    try {
      done = document.execCommand("copy");
    } catch {
      // Not offered either.
    }
    area.remove();
    focused?.focus();
    return done;
  }
}

for (const button of document.querySelectorAll("button.copy")) {
  button.hidden = false;
  let timer = 0;
  button.addEventListener("click", async () => {
    const frame = button.closest(".copyable");
    const code = frame.querySelector("code");
    const done = await copyText(code.textContent);
    if (!done) {
      frame.querySelector("details")?.setAttribute("open", "");
      getSelection().selectAllChildren(code);
    }
    button.textContent = done ? "Copied" : "Press Ctrl+C";
    button.classList.toggle("done", done);
    status.textContent = done ? "Copied." : "The text is selected; copy it with the keyboard.";
    clearTimeout(timer);
    timer = setTimeout(() => {
      button.textContent = "Copy";
      button.classList.remove("done");
      status.textContent = "";
    }, 2000);
  });
}

// What scrolls sideways can be reached and scrolled with the keyboard; what does not is no stop for it.
function reachScrollers() {
  for (const box of document.querySelectorAll(".scroll")) {
    if (box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1) {
      box.tabIndex = 0;
    } else {
      box.removeAttribute("tabindex");
    }
  }
}
reachScrollers();
addEventListener("resize", reachScrollers);
document.addEventListener("toggle", reachScrollers, true);

// The contents show where the reader is.
const links = new Map([...document.querySelectorAll("nav li a")].map((link) => [link.hash.slice(1), link]));
const contents = document.querySelector("nav");
const inView = new Set();
const watch = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    inView[entry.isIntersecting ? "add" : "delete"](entry.target.id);
  }
  const current = [...links.keys()].find((id) => inView.has(id));
  for (const [id, link] of links) {
    if (id === current) {
      link.setAttribute("aria-current", "true");
      contents.scrollTo({ left: link.offsetLeft - contents.clientWidth / 2 });
    } else {
      link.removeAttribute("aria-current");
    }
  }
}, { rootMargin: "-20% 0px -70% 0px" });
for (const id of links.keys()) {
  const target = document.getElementById(id);
  if (target) {
    watch.observe(target);
  }
}
