// Materials of the room that a fake server draws, as the real server tells them.
const channels = (quantity) =>
    ["red", "green", "blue"].map((channel) => ({ quantity, channel, low: 0, high: 1, unit: "" }));
const single = (quantity, low = 0, high = 1, unit = "") => ({
    quantity,
    channel: "",
    low,
    high,
    unit,
});

const plastic = (name, reals) => ({
    name,
    definition: 0,
    kind: "plastic",
    modifier: "weave",
    where: "room/room.rad:7",
    strings: [],
    names: [...channels("reflectance"), single("specularity"), single("roughness")],
    built: reals,
    reals,
    fixed: "",
});
const kPattern = {
    name: "weave",
    definition: 0,
    kind: "colorpict",
    modifier: "void",
    where: "room/room.rad:6",
    strings: ["red", "green", "blue", "weave.hdr"],
    names: [],
    built: [],
    reals: [],
    fixed: "",
};
const kGlow = {
    ...plastic("lamp of a file", [10, 10, 10, -1]),
    kind: "glow",
    names: [
        ...channels("radiance").map((one) => ({ ...one, high: 1e9, unit: "W/(m² sr)" })),
        single("reach of its light", -1e6, 1e6, "m"),
    ],
    fixed: "It belongs to a file that the scene places: change it there.",
};

/** The answer to a `material` message where the picture shows `hit`. */
export const material_message = (id, hit) => ({
    type: "material",
    id,
    hit: hit !== null && hit !== undefined,
    surface: hit?.surface ?? "",
    layers: hit ? [plastic(hit.material, [0.5, 0.5, 0.5, 0, 0.1]), kPattern, kGlow] : [],
});

/** The answer to an `edits` message: reflectances of just .123 are refused. */
export function edited_message({ id, materials }) {
    const wrong = ({ reals }) => reals[0] === 0.123;
    return {
        type: "edited",
        id,
        materials: materials.filter((one) => !wrong(one)),
        refused: materials.filter(wrong).map(({ name, definition }) => ({
            name,
            definition,
            why: "nobody paints so",
        })),
    };
}
