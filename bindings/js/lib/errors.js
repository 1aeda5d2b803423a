/** A call that vox refused: `code` is one of Result, the message says what was wrong, with numbers in it. */
export class VoxError extends Error {
  constructor(code, text) {
    super(text);
    this.code = code;
  }
}
VoxError.prototype.name = "VoxError";
