"""A small rasteriser for contact sheets: smooth shaded triangles and a PNG writer."""
import struct
import zlib

import numpy as np


def vertex_normals(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    face = np.cross(b - a, c - a)
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], face)
    return normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]


def draw(vertices, triangles, center, height, size, yaw=0, pitch=0, oversample=2, ground=True):
    """A picture (rows, columns, 3) of values 0 to 1: parallel projection, `height` metres tall.

    `yaw` [degrees] turns the viewer to the person's left, `pitch` lifts the viewer.
    """
    width_px, height_px = size[0] * oversample, size[1] * oversample
    y, p = np.radians(yaw), np.radians(pitch)
    toward = np.array([np.sin(y) * np.cos(p), np.sin(p), np.cos(y) * np.cos(p)])
    right = np.array([np.cos(y), 0, -np.sin(y)])
    up = np.cross(toward, right)
    scale = height_px / height
    local = (vertices - center) @ np.stack([right, up, toward]).T
    xy = np.stack([width_px / 2 + scale * local[:, 0], height_px / 2 - scale * local[:, 1]], -1)
    normals = vertex_normals(vertices, triangles) @ np.stack([right, up, toward]).T

    depth = np.full(width_px * height_px, -np.inf)
    shade = np.full((width_px * height_px, 3), np.nan)
    corners = xy[triangles]
    low = np.floor(corners.min(1)).astype(int)
    extent = (np.ceil(corners.max(1)).astype(int) - low).max(1)
    area = ((corners[:, 1, 0] - corners[:, 0, 0]) * (corners[:, 2, 1] - corners[:, 0, 1])
            - (corners[:, 1, 1] - corners[:, 0, 1]) * (corners[:, 2, 0] - corners[:, 0, 0]))
    last = 0
    for reach in (2, 4, 8, 16, 32, 64, 128, 512):  # triangles of similar size together
        pick = np.flatnonzero((extent > last) & (extent <= reach) & (area < 0))
        last = reach
        for part in np.array_split(pick, max(1, len(pick) * reach * reach // 2000000)):
            if len(part):
                fill(part, reach, corners, low, area, triangles, local, normals, depth, shade,
                     width_px, height_px)
    image = background(height_px, width_px)
    hit = ~np.isnan(shade[:, 0])
    image[hit] = shade[hit]
    image = image.reshape(size[1], oversample, size[0], oversample, 3).mean((1, 3))
    return image


def background(rows, columns):
    fade = np.linspace(.93, .84, rows)[:, None, None]
    return np.broadcast_to(fade, (rows, columns, 3)).reshape(-1, 3).copy()


def fill(part, reach, corners, low, area, triangles, local, normals, depth, shade, columns, rows):
    """Draws some triangles of at most `reach` pixels, the nearest at each pixel staying."""
    offset = np.stack(np.meshgrid(np.arange(reach + 1), np.arange(reach + 1)), -1).reshape(-1, 2)
    pixel = low[part][:, None] + offset[None]
    center = pixel + .5
    c = corners[part]

    def edge(a, b):
        return ((c[:, b, 0] - c[:, a, 0])[:, None] * (center[..., 1] - c[:, a, 1][:, None])
                - (c[:, b, 1] - c[:, a, 1])[:, None] * (center[..., 0] - c[:, a, 0][:, None]))
    weight = np.stack([edge(1, 2), edge(2, 0), edge(0, 1)], -1) / area[part][:, None, None]
    ok = ((weight >= 0).all(-1) & (pixel >= 0).all(-1) & (pixel[..., 0] < columns)
          & (pixel[..., 1] < rows))
    which, spot = np.nonzero(ok)
    if not len(which):
        return
    weight = weight[which, spot]
    t = triangles[part[which]]
    z = (local[t, 2] * weight).sum(1)
    at = pixel[which, spot, 1] * columns + pixel[which, spot, 0]

    # Later writes win, so the nearest are written last.
    order = np.argsort(z, kind='stable')
    at, z, weight, t = at[order], z[order], weight[order], t[order]
    front = z > depth[at]
    at, z, weight, t = at[front], z[front], weight[front], t[front]
    normal = (normals[t] * weight[..., None]).sum(1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-12)[:, None]
    depth[at] = z
    shade[at] = light(normal)


def light(normal):
    """Key light from the upper left, fill from the right, a rim that sets the outline off."""
    key = np.maximum(normal @ np.array([-.50, .58, .64]), 0)
    fill_in = np.maximum(normal @ np.array([.80, .10, .45]), 0)
    sky = .5 + .5 * normal[:, 1]
    rim = (1 - np.clip(normal[:, 2], 0, 1)) ** 3
    value = .10 + .62 * key + .16 * fill_in + .16 * sky - .10 * rim
    return np.clip(value[:, None] * np.array([1.0, .95, .88]), 0, 1)


def write_png(path, image):
    data = (np.clip(image, 0, 1) ** (1 / 1.15) * 255 + .5).astype(np.uint8)
    height, width = data.shape[:2]
    rows = data.reshape(height, -1)
    rows = np.diff(rows.astype(int), axis=0, prepend=0).astype(np.uint8)  # PNG's filter "up"
    rows = np.concatenate([np.full((height, 1), 2, np.uint8), rows], 1)

    def chunk(kind, body):
        return (struct.pack('>I', len(body)) + kind + body
                + struct.pack('>I', zlib.crc32(kind + body)))
    with open(path, 'wb') as f:
        f.write(b'\x89PNG\r\n\x1a\n')
        f.write(chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)))
        f.write(chunk(b'IDAT', zlib.compress(rows.tobytes(), 9)) + chunk(b'IEND', b''))
