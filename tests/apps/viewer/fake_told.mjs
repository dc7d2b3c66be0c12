// What the fake server says of its scene.
export const kEyeHeight = 1.6;

const view_at = (position, direction, horizontal = 70) => ({
    type: "v",
    position,
    direction,
    up: [0, 0, 1],
    horizontal,
    vertical: 50,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
});
export const kViews = [
    { name: "entrance", view: view_at([3, -2.2, kEyeHeight], [-0.85, 0.52, -0.05]) },
    { name: "window seat", view: view_at([0.2, -2.4, kEyeHeight], [0, 1, -0.04]) },
    { name: "west wall", view: view_at([2.4, -1, kEyeHeight], [-1, 0.05, -0.08]) },
];

export const kLoaded = {
    type: "loaded",
    beside: { scene: "" },
    views: kViews,
    eye_height: kEyeHeight,
    lights: ["sun", "sky", "desk lamp"],
    time: {
        time: { month: 9, day: 21, hour: 14.3, sky: "+s" },
        solar: false,
        types: true,
        latitude: 46,
        longitude: 7,
    },
};

export const kFollowed = {
    type: "followed",
    files: [],
    materials: 0,
    sources: 0,
    surfaces: 0,
    kept: 0,
    problems: [],
    lights: kLoaded.lights,
    time: kLoaded.time,
};
