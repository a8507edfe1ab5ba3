/** An array of numbers: one member, named after the type, with little-endian base64. */
export type Packed =
  | { f32: string }
  | { i32: string }
  | { u32: string }
  | { u8: string }
  | { u64: string };

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

function text(packed: unknown, type: string): string {
  const value = (packed as Record<string, unknown> | null)?.[type];
  if (typeof value !== 'string') throw new Error(`an array of type ${type} is missing`);
  return value;
}

export function float32(packed: unknown): Float32Array {
  return new Float32Array(bytesOf(text(packed, 'f32')).buffer);
}

export function int32(packed: unknown): Int32Array {
  return new Int32Array(bytesOf(text(packed, 'i32')).buffer);
}

export function uint32(packed: unknown): Uint32Array {
  return new Uint32Array(bytesOf(text(packed, 'u32')).buffer);
}

export function uint8(packed: unknown): Uint8Array {
  return bytesOf(text(packed, 'u8'));
}

/** 64-bit numbers, exact. */
export function uint64(packed: unknown): BigUint64Array {
  return new BigUint64Array(bytesOf(text(packed, 'u64')).buffer);
}
