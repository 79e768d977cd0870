// Tests files of one's own and the page with more engines, in a headless Chromium.
//   node files_test.mjs PAGE.html SHOTS-FOLDER FOLDER-OF-node_modules
import {
  atStep,
  browser,
  check,
  choose,
  click,
  expect,
  finish,
  inAddress,
  matches,
  open,
  page,
  pick,
  quiet,
  run,
  shoot,
  text,
  until,
} from "./page_driver.mjs";

const urdf = (link) => `<?xml version="1.0"?>
<robot name="two-links">
  <link name="base">
    <inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.4 0.4 0.4"/></geometry></collision>
  </link>
  <link name="arm">
    <inertial><origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    ${link}
  </link>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/></joint>
</robot>
`;
// The eight corners of a cube of 0.2 m.
const obj = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => `v ${0.1 * x} ${0.1 * y} ${0.1 * z}`))).join("\n") + "\nf 1 2 4\nf 1 4 3\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\n";
const sdf = `<sdf version="1.7"><model name="ball"><pose>0 0 3 0 0 0</pose><link name="ball">
<inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link></model></sdf>`;
const mjcf = (rest) => `<mujoco model="pendulum"><option gravity="0 0 -9.81"/><worldbody>
<body name="rod"><joint name="pivot" type="hinge" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02"/></body>
${rest}</worldbody></mujoco>
`;

const error = () => until("document.querySelector('#file-error')", "the reader's message", 30);
const title = (words) => until(`document.querySelector('h1').textContent.includes(${JSON.stringify(words)})`, `the title ${words}`, 30);

await finish(async () => {
  await check("a case file of one's own is shown", async () => {
    await open();
    const scene =
      '# A stone.\ntitle = "<b>Stone</b>"\n[scene]\ngravity = [0, -9.8, 0]\n[[scene.body]]\nname = "stone"\nmass = 2\ninertia = [1, 1, 1]\n[run]\nduration = 1\ndt = ["1/30"]\n[truth]\nkind = "projectile"\n';
    await choose({ "stone.toml": scene });
    await until("document.querySelector('h1').textContent === '<b>Stone</b>'", "its title as text");
    await until("document.querySelector('#truth-note').textContent.startsWith('Truth: projectile')", "its truth");
  });
  await check("a broken one is refused with its line marked", async () => {
    await choose({
      "broken.toml":
        'title = "x"\n[scene]\n[[scene.body]]\nname = "stone"\nmas = 2\n[run]\nduration = 1\ndt = ["1/30"]\n',
    });
    await until("document.querySelector('.own-file mark')", "the mark");
    matches(await text("#file-error"), /broken\.toml:5:/, "the message");
    matches(await text(".own-file mark"), /mas = 2/, "the marked line");
    await shoot("broken-file-1400");
  });
  await check("a robot in URDF moves, and a floor can be put below it", async () => {
    await open("#/springs/fixed-spring?runs=core:semi-implicit-euler");
    await choose({ "robot.urdf": urdf("") });
    await title("two-links");
    matches(await text(".own-file"), /falls without end: nothing holds it/, "what the import says");
    await click("#add-floor");
    await until("document.querySelector('.own-file') && !document.querySelector('#add-floor')", "a floor", 30);
    await click("#step");
    await atStep(1);
    await shoot("robot-1400");
    await quiet();
  });
  await check("its mesh comes with it", async () => {
    const arm = '<collision><geometry><mesh filename="meshes/arm.obj"/></geometry></collision>';
    await open();
    await choose({ "robot.urdf": urdf(arm), "arm.obj": obj });
    await title("two-links");
    expect(!(await text(".own-file")).includes("arm.obj"), await text(".own-file"));
    await open();
    await choose({ "robot.urdf": urdf(arm) });
    await until("document.querySelector('.own-file').textContent.includes('arm.obj')", "a word on the mesh that is missing", 30);
  });
  await check("a robot in SDF moves", async () => {
    await open();
    await choose({ "ball.sdf": sdf });
    await title("ball");
  });
  await check("a broken robot is refused with its line marked, and the scene before stays", async () => {
    await open();
    const before = await text("h1");
    await choose({ "broken.urdf": urdf("").replace('<mass value="1"/>', '<mass value="heavy"/>') });
    await error();
    matches(await text("#file-error"), /^broken\.urdf:8:/, "the message");
    matches(await text(".own-file mark"), /heavy/, "the marked line");
    expect((await text("h1")) === before, "another scene is shown");
    await shoot("broken-robot-1400");
    await choose({ "open.urdf": "<robot name='x'>\n<link name='a'>\n</robot>\n" });
    await until("document.querySelector('#file-error').textContent.startsWith('open.urdf:')", "the message of XML", 30);
  });
  await check("MJCF is told to need MuJoCo where there is none", async () => {
    await open();
    await choose({ "pendulum.xml": mjcf("") });
    await until("document.querySelector('.own-file').textContent.includes('MuJoCo reads MJCF')", "the reason");
  });
  await check("the other page has seven engines beside the core, with the same state", async () => {
    await open("#/contact/collision?runs=core:velocity-verlet,contact=event&dt=1/60&restitution=0.25");
    await click("#other-page");
    await until("location.pathname.endsWith('engines.html') && document.documentElement.dataset.ready", "the other page", 30);
    await inAddress("restitution=0.25");
    await click("#add-run"), await until("document.querySelectorAll('.run-row').length === 2", "a second run");
    await pick(".run-row:nth-of-type(2) select", "rapier");
    await inAddress("~rapier");
    await quiet();
  });
  const more = (fragment) => open(fragment, page.replace(/[^/]*$/, "engines.html"));
  for (const [scene, engines] of [
    ["contact/bounce-half", ["rapier", "jolt", "physx"]],
    ["contact/bounce-half", ["havok", "ammo", "cannon-es"]],
    ["joints/pendulum-90", ["mujoco-js", "havok", "physx"]],
  ]) {
    await check(`${engines.join(", ")} run ${scene} in workers, offline`, async () => {
      await more(`#/${scene}?runs=core:velocity-verlet~${engines.join("~")}&dt=1/60`);
      await until("!document.querySelector('.now').textContent.includes('–')", "figures of all", 60);
      await pick("#speed", "4");
      await click("#play");
      await until("Number(document.querySelector('main').dataset.step) >= 50", "50 steps", 60);
      await click("#play");
      for (const name of engines) matches(await text(`.now [data-run='${name}'] td:nth-of-type(2)`), /m$/, `the error of ${name}`);
      await shoot(`engines-${engines[0]}-1400`);
      await quiet();
    });
  }
  await check("its policy, too, runs no script that markup brings in", async () => {
    await more("#/%3Cimg src=x onerror=alert(1)%3E?runs=%3Cscript%3Ealert(1)%3C/script%3E");
    expect(!(await run("return document.querySelector('main img, main script')")), "markup came in");
    const ran = "const s = document.createElement('script'); s.textContent = 'window.wasRun = true'; document.body.append(s); return window.wasRun === true";
    expect(!(await run(ran)), "a script of the page's own text ran");
    await browser.complaints(); // the browser tells of the script that it refused
  });
  await check("MuJoCo reads a dropped MJCF there, and names the line of a mistake", async () => {
    await more("#/springs/fixed-spring?runs=core:semi-implicit-euler~mujoco-js");
    await choose({ "pendulum.xml": mjcf("") });
    await title("as its MJCF file has it");
    await until("!document.querySelector('.now').textContent.includes('–')", "figures of both", 60);
    await choose({ "broken.xml": mjcf('<body name="x"><geom type="cone" size="1"/></body>\n') });
    await error();
    matches(await text("#file-error"), /^broken\.xml:3: MuJoCo/, "the message");
    matches(await text(".own-file mark"), /cone/, "the marked line");
    await quiet();
  });
});
