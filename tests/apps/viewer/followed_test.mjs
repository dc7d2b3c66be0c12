import assert from "node:assert/strict";
import { test } from "node:test";
import { followed_text } from "../../../apps/viewer/followed.js";

test("edited files are told with what they change", () => {
    const none = { materials: 0, sources: 0, surfaces: 0 };
    const text = (files, counts) => followed_text({ files, ...none, ...counts });
    assert.equal(text(["room.rad"], { materials: 3 }), "room.rad changed: 3 materials");
    assert.equal(
        text(["room.rad", "sky.rad"], { materials: 1, sources: 2, surfaces: 12 }),
        "room.rad and sky.rad changed: 1 material, 2 sources, 12 surfaces",
    );
    assert.equal(text(["a", "b", "c", "d"], {}), "a and b and 2 more changed: read again");
    assert.equal(text([], { surfaces: 1 }), "The scene changed: 1 surface");
});
