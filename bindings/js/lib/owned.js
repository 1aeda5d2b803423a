import { Result } from "../enums.js";
import { VoxError } from "./errors.js";

let state;

/** Something in the module's memory, until dispose(). What is forgotten is released when it was collected. */
export class Owned {
  #state;

  constructor(memory, kind, pointer, release) {
    this.#state = { memory, kind, pointer, release, calling: false };
    memory.watch(this, release, pointer);
  }

  static {
    state = (owned) => owned.#state;
  }

  /** Returns the memory at once. Twice is as good as once; any other use of it afterwards is an error. In a module that has
   * stopped it does nothing, so that the end of a block does not hide why it stopped. */
  dispose() {
    const { memory, release, pointer, calling } = this.#state;
    if (pointer === 0) return;
    if (calling) pointerOf(this);
    this.#state.pointer = 0;
    memory.unwatch(this);
    if (!memory.stopped) release(pointer);
  }

  get disposed() {
    return this.#state.pointer === 0;
  }
}
if (Symbol.dispose)
  Object.defineProperty(Owned.prototype, Symbol.dispose, { value: Owned.prototype.dispose, configurable: true, writable: true });

export function memoryOf(owned) {
  return state(owned).memory;
}

export function pointerOf(owned) {
  const { kind, pointer, calling } = state(owned);
  if (pointer === 0) throw new VoxError(Result.ERROR_INVALID_STATE, `this ${kind} was disposed`);
  if (calling) throw new VoxError(Result.ERROR_INVALID_STATE, `this ${kind} is in a call, whose log must not use it`);
  return pointer;
}

/** The pointer of what must be of this kind and module. */
export function pointerOfKind(owned, kind, memory, what) {
  if (!(owned instanceof Owned) || state(owned).kind !== kind || state(owned).memory !== memory)
    throw new TypeError(`${what}: expected a ${kind} of this module`);
  return pointerOf(owned);
}

/** The library has put something else in the place of what was owned. */
export function setPointer(owned, pointer) {
  const its = state(owned);
  its.pointer = pointer;
  its.memory.unwatch(owned);
  its.memory.watch(owned, its.release, pointer);
}

/** Runs what calls logs, or is one: the library does not allow it to use any of `all`. */
export function guarded(all, run) {
  const free = all.map(state).filter((its) => !its.calling);
  for (const its of free) its.calling = true;
  try {
    return run();
  } finally {
    for (const its of free) its.calling = false;
  }
}
