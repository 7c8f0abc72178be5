// The camera of a view, as a Lapidary frame holds it, and the same camera a little turned.

/** Reads the camera from the first buffer of a frame that is named `view`. */
export function camera(frame) {
  const [place] = frame.buffers('view');
  return { clip: frame.field(place, 'clip_from_world'), eye: frame.field(place, 'eye') };
}

/** Rotates a vector about the vertical, from +z towards +x. */
function rotated([x, y, z], angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c * x + s * z, y, c * z - s * x];
}

/** Product of a matrix, by columns, and the rotation of the world by an angle. */
function afterRotation(matrix, angle) {
  const product = [];
  for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
    const turned = rotated(axis, angle);
    for (let row = 0; row < 4; row++) {
      product.push(matrix[row] * turned[0] + matrix[4 + row] * turned[1] + matrix[8 + row] * turned[2]);
    }
  }
  return [...product, ...matrix.slice(12)];
}

/** The camera after a walk of `degrees` around the world's vertical axis. */
export function turned({ clip, eye }, degrees) {
  const angle = (degrees * Math.PI) / 180;
  return { clip: afterRotation(clip, -angle), eye: rotated(eye, angle) };
}

/** Turns the camera of a frame, in each of its tiles. At 0 degrees it is where it was. */
export function turnFrame(frame, degrees) {
  for (const place of frame.buffers('view')) {
    const start = { clip: frame.field(place, 'clip_from_world'), eye: frame.field(place, 'eye') };
    const { clip, eye } = degrees === 0 ? start : turned(start, degrees);
    frame.write(place, 'clip_from_world', clip);
    frame.write(place, 'eye', eye);
  }
}
