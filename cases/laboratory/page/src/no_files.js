// In place of node:fs, which serve.mjs uses: a page has none.
const none = () => {
  throw new Error("a page has no files");
};
export const readSync = none;
export const writeSync = none;
export const createRequire = none;
