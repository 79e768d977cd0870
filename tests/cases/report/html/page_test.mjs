// Tests the report in a headless Chromium, as a reader would use it.
// node page_test.mjs REPORT.html RESULTS.json SHOTS-FOLDER
// Prints the result of each check; the exit code is 0 if all passed. Screenshots stay in the folder.
import { Browser } from "./browser.mjs";
import { everyCase, oneCase } from "./case_checks.mjs";
import { firstScreen } from "./first_screen_checks.mjs";
import { jointedCase } from "./joint_checks.mjs";
import { looks, withoutWebgl } from "./look_checks.mjs";
import { summed } from "./report_page.mjs";

const browser = await Browser.open();
try {
  await firstScreen(browser);
  await oneCase(browser);
  await jointedCase(browser);
  await everyCase(browser);
} finally {
  await browser.close();
}
await looks();
await withoutWebgl();
process.exit(summed());
