// Pictures and numbers as files.
export function savedAs(name, text) {
  const type = name.endsWith(".svg") ? "image/svg+xml" : "text/csv";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// With the colours and fonts that the page's style gives it, so that it looks the same by itself.
export function svgText(picture) {
  const copy = picture.cloneNode(true);
  const parts = [picture, ...picture.querySelectorAll("*")],
    copies = [copy, ...copy.querySelectorAll("*")];
  const kept = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-weight", "font-family"];
  parts.forEach((part, i) => {
    const style = getComputedStyle(part);
    copies[i].setAttribute("style", kept.map((key) => `${key}:${style.getPropertyValue(key)}`).join(";"));
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  return new XMLSerializer().serializeToString(copy);
}
