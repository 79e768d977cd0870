// The playback's clock, which the picture and the plots follow.
import { set } from "./state.js";

export class Player {
  constructor(duration) {
    (this.duration = duration), (this.time = 0), (this.speed = duration > 20 ? 2 : 1), (this.dt = 1 / 30);
    (this.playing = false), (this.listeners = new Set());
  }
  onTick(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
  close() {
    (this.playing = false), this.listeners.clear();
  }

  seek(time, { keepPlaying = false } = {}) {
    if (!keepPlaying) this.playing = false;
    this.time = Math.min(this.duration, Math.max(0, time));
    set({ time: this.time });
    this.tell();
  }
  step(count) {
    this.seek((Math.round(this.time / this.dt) + count) * this.dt);
  }
  faster(factor) {
    this.speed = Math.min(16, Math.max(1 / 64, this.speed * factor));
    this.tell();
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing) {
      if (this.time >= this.duration - 1e-9) this.time = 0;
      this.before = null;
      requestAnimationFrame((now) => this.frame(now));
    }
    this.tell();
  }

  frame(now) {
    if (!this.playing) return;
    // After a pause of the page, a hidden tab say, playback goes on where it was.
    const passed = this.before === null ? 0 : Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    this.time += passed * this.speed;
    if (this.time >= this.duration) (this.time = this.duration), (this.playing = false);
    set({ time: this.time });
    this.tell();
    requestAnimationFrame((later) => this.frame(later));
  }

  tell() {
    for (const listener of this.listeners) listener(this.time);
  }
}
