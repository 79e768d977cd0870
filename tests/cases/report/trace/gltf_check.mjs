// Prints the world poses of the bodies at a time according to three.js, one line of JSON.
// node gltf_check.mjs PAGE_FOLDER FILE TIME
import { readFileSync } from "node:fs";

const [folder, file, time] = process.argv.slice(2);
globalThis.self = globalThis; // the loader is written for browsers
globalThis.ProgressEvent ??= class {};
const THREE = await import(`${folder}/node_modules/three/build/three.module.js`);
const { GLTFLoader } = await import(`${folder}/node_modules/three/examples/jsm/loaders/GLTFLoader.js`);
const gltf = await new GLTFLoader().parseAsync(readFileSync(file, "utf8"), "");
const mixer = new THREE.AnimationMixer(gltf.scene);
const action = mixer.clipAction(gltf.animations[0]).setLoop(THREE.LoopOnce);
action.clampWhenFinished = true;
action.play();
mixer.setTime(Number(time));
gltf.scene.updateMatrixWorld(true);
const bodies = {};
for (const node of gltf.scene.getObjectByName("world").children) {
  const position = new THREE.Vector3(), turn = new THREE.Quaternion(), scale = new THREE.Vector3();
  node.matrixWorld.decompose(position, turn, scale);
  const box = new THREE.Box3().setFromObject(node);
  bodies[node.name] = { position: position.toArray(), turn: turn.toArray(), size: box.getSize(new THREE.Vector3()).toArray() };
}
console.log(JSON.stringify({ duration: gltf.animations[0].duration, bodies }));
