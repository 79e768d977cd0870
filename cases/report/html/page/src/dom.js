// Elements from plain values. Text goes in as text, never as markup: names come from other people's files.
export function el(tag, attributes, ...children) {
  const [name, ...classes] = tag.split(".");
  const node = document.createElement(name || "div");
  if (classes.length) node.className = classes.join(" ");
  fill(node, attributes, children);
  return node;
}

export function svg(tag, attributes, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  fill(node, attributes, children);
  return node;
}

function fill(node, attributes, children) {
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (key === "style" && typeof value === "object") {
      for (const [name, text] of Object.entries(value)) node.style.setProperty(name, text);
    } else node.setAttribute(key, value === true ? "" : value);
  }
  add(node, children);
}

export function add(node, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    node.append(child instanceof Node ? child : String(child));
  }
  return node;
}

export function replace(node, ...children) {
  node.replaceChildren();
  return add(node, children);
}

// The first row of a table.
export const tableHead = (...labels) =>
  el(
    "thead",
    {},
    el(
      "tr",
      {},
      labels.flat().map((label) => (label instanceof Node ? label : label === "" ? el("td") : el("th", { scope: "col" }, label))),
    ),
  );

// Formulas of plain text as they are set: powers raised, Greek letters, products of two symbols set apart.
export function typeset(text) {
  const greek = { omega: "ω", theta: "θ", mu: "µ" };
  return text
    .replace(/\b(omega|theta|mu)\b/g, (word) => greek[word])
    .split(/(\^(?:-?\d+|\([^)]*\)))/)
    .map((part) => (part.startsWith("^") ? el("sup", {}, part.slice(1).replace(/^\(|\)$/g, "").replace("-", "−")) : part));
}

// Comes once the browser has painted what there is; at the latest after 0.2 s, for a page in the background is not
// painted.
export const afterFirstPaint = () =>
  new Promise((resolve) => {
    setTimeout(resolve, 200);
    requestAnimationFrame(() => setTimeout(resolve));
  });
