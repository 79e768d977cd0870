// In place of Node's modules, for engines of the npm registry: a page has no files but those that build.mjs packed with
// the engine.
const none = () => {
  throw new Error("a page has no files");
};
export const readSync = none;
export const writeSync = none;
export const createRequire = () => ({ resolve: (name) => self.rigorPlaces[name] ?? none() });
export function readFileSync(path, encoding) {
  const bytes = Uint8Array.from(atob(self.rigorFiles[path] ?? none()), (letter) => letter.charCodeAt(0));
  return encoding ? new TextDecoder().decode(bytes) : bytes;
}
export default {};
