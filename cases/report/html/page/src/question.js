// The question that a case asks, from its main error and the comment at the head of its file.
const questions = {
  position_error: "How far does each engine's motion stray from the true path?",
  orientation_error: "How far does each engine's rotation stray from the true one?",
  mean_position_error: "How far does each engine's motion stray from the recorded one?",
  mean_rotation_error: "How far does each engine's rotation stray from the recorded one?",
};

// The paragraphs of the comment at the head of the file.
function headOf(file) {
  const lines = (file ?? "").split("\n"),
    end = lines.findIndex((line) => !line.startsWith("#"));
  return lines
    .slice(0, end < 0 ? lines.length : end)
    .map((line) => line.slice(1).trim())
    .join("\n")
    .split(/\n\s*\n/)
    .map((part) => part.replaceAll("\n", " ").trim())
    .filter(Boolean);
}

export function questionOf(one) {
  const watch = headOf(one.file).find((part) => part.startsWith("Watch:"));
  return [questions[one.main] ?? "Does each engine keep the energy that it should keep?", watch].filter(Boolean).join(" ");
}
