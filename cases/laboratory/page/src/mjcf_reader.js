// In the worker of MuJoCo: it reads MJCF, too. The simulators ask it as they ask an engine (wasm/child_in_page.cpp); what
// MuJoCo prints meanwhile are its warnings.
export function readMjcf(answerTo) {
  const answerOfEngine = self.rigorAnswer;
  self.rigorReadsMjcf = true;
  self.rigorAnswer = (line) => {
    if (!line.startsWith('{"package"')) return answerOfEngine(line);
    const request = JSON.parse(line),
      warnings = [],
      { error } = console;
    console.error = (text) => warnings.push(String(text));
    try {
      const read = (name, encoding) => self.rigorFile(`${request.folder}/${name}`, encoding);
      return JSON.stringify(answerTo(request, read, warnings));
    } finally {
      console.error = error;
    }
  };
}
