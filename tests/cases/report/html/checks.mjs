// Counted checks of the tests in JavaScript.
let passed = 0,
  failed = 0;
export async function check(name, body) {
  try {
    await body();
    ++passed;
    console.log(`ok    ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAIL  ${name}: ${error.message}`);
  }
}
export function expect(condition, message) {
  if (!condition) throw new Error(message);
}
// Prints the sum, and returns the exit code: 0 if all passed.
export function summed() {
  console.log(`${passed} passed, ${failed} failed`);
  return failed ? 1 : 0;
}
// Chromium tells of screenshots that they cost time; of the page it must have nothing to say.
export async function quiet(browser) {
  const complaints = (await browser.complaints()).filter((text) => !text.includes("GPU stall due to ReadPixels"));
  expect(!complaints.length, complaints.join("\n"));
}
