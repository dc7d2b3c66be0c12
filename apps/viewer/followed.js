// What has become of edited files, in words.

const counted = (number, one, many) => `${number} ${number === 1 ? one : many}`;

/** The names of files, the first ones of many. */
function names_of(files) {
    const shown = files.slice(0, 2).join(" and ");
    return files.length > 2 ? `${shown} and ${files.length - 2} more` : shown;
}

/** A line on files that are followed: {files, materials, sources, surfaces}. */
export function followed_text({ files = [], materials, sources, surfaces }) {
    const parts = [
        materials > 0 && counted(materials, "material", "materials"),
        sources > 0 && counted(sources, "source", "sources"),
        surfaces > 0 && counted(surfaces, "surface", "surfaces"),
    ].filter(Boolean);
    const what = parts.length > 0 ? parts.join(", ") : "read again";
    return `${names_of(files) || "The scene"} changed: ${what}`;
}
