// What axe-core (the rules of WCAG 2 A and AA, and best practices) finds wrong with a page.
import { readFile } from "node:fs/promises";
import path from "node:path";

/** The rules that the page breaks, with the elements that do, as texts; nothing where npm's folder has no axe-core. */
export async function axe_complaints(page, npm) {
    const file = path.resolve(npm, "node_modules/axe-core/axe.min.js");
    const source = await readFile(file, "utf8").catch(() => null);
    if (source === null) return null;
    await page.evaluate(source);
    const { violations } = await page.evaluate(() => window.axe.run(document));
    return violations.flatMap(({ id, help, nodes }) =>
        nodes.map(({ html, failureSummary }) => `${id}: ${help}\n${html}\n${failureSummary}`),
    );
}
