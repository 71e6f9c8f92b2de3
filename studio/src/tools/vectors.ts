// Places and directions in space as triples.
export type Place = [number, number, number];

export const add = (p: Place, q: Place, s = 1): Place => [p[0] + s * q[0], p[1] + s * q[1], p[2] + s * q[2]];
export const dot = (p: Place, q: Place) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
export const cross = (p: Place, q: Place): Place => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
export const size = (p: Place) => Math.hypot(...p);
export const unit = (p: Place): Place => {
    const l = size(p) || 1;
    return [p[0] / l, p[1] / l, p[2] / l];
};
