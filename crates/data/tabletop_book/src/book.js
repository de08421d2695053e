"use strict";
const chapters = [...document.querySelectorAll("article")];
const entries = [...document.querySelectorAll("#contents > ul > li")];
const search = document.getElementById("search");
const found = document.getElementById("found");
const contents = document.getElementById("contents");
const MOST_FOUND = 40;

// Shows the chapter in which the address leads.
function read() {
  const place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const chapter = (place && place.closest("article")) || chapters[0];
  const heading = chapter.querySelector("h1");
  document.body.className = "read";
  document.title = heading ? `${heading.textContent} – tabletop` : "tabletop";
  chapters.forEach((it, i) => {
    it.classList.toggle("here", it === chapter);
    entries[i].classList.toggle("here", it === chapter);
  });
  (place || document.body).scrollIntoView();
}

// The sections of all chapters, each with its text.
let sections;
function indexed() {
  if (sections) return sections;
  sections = [];
  for (const chapter of chapters) {
    const name = chapter.querySelector("h1").textContent;
    let section = { id: chapter.id, title: name, text: "" };
    for (const element of chapter.children) {
      if (element.tagName === "FOOTER") continue;
      if (/^H[23]$/.test(element.tagName)) {
        sections.push(section);
        section = { id: element.id, title: `${name}: ${element.textContent}`, text: "" };
      } else {
        section.text += " " + element.textContent;
      }
    }
    sections.push(section);
  }
  for (const section of sections) {
    section.text = section.text.replace(/\s+/g, " ");
    section.low = section.text.toLowerCase();
    section.head = section.title.toLowerCase();
  }
  return sections;
}

// The sections that have all words, those with words in their titles first.
function matching(words) {
  const has = (it) => words.every((word) => it.low.includes(word) || it.head.includes(word));
  const rank = (it) => words.filter((word) => it.head.includes(word)).length;
  return indexed().filter(has).sort((a, b) => rank(b) - rank(a)).slice(0, MOST_FOUND);
}

function excerpt(section, word) {
  const at = Math.max(0, section.low.indexOf(word) - 40);
  const text = section.text.slice(at, at + 110).trim();
  return (at > 0 ? "…" : "") + text + "…";
}

function find() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  found.hidden = words.length === 0;
  contents.hidden = words.length > 0;
  found.replaceChildren();
  if (words.length === 0) return;
  const matches = matching(words);
  for (const section of matches) {
    const link = document.createElement("a");
    link.href = "#" + section.id;
    link.textContent = section.title;
    const text = document.createElement("small");
    text.textContent = excerpt(section, words[0]);
    link.append(text);
    const item = document.createElement("li");
    item.append(link);
    found.append(item);
  }
  if (matches.length === 0) {
    const item = document.createElement("li");
    item.textContent = "Nothing is found.";
    found.append(item);
  }
}

search.addEventListener("input", find);
addEventListener("hashchange", read);
addEventListener("keydown", (event) => {
  if (event.target === search) {
    if (event.key === "Escape") { search.value = ""; find(); search.blur(); }
    if (event.key === "Enter") { const first = found.querySelector("a"); if (first) first.click(); }
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const link = (kind) => document.querySelector(`article.here .${kind} a`);
  const target = { ArrowLeft: link("before"), ArrowRight: link("after") }[event.key];
  if (target) target.click();
  if (event.key === "/") { event.preventDefault(); search.focus(); }
});
read();
