// Measures how soon the page of a walk answers the hand, by the tracing of headless Chromium: the real page and the real server, behind delays.
//
//     node perf/input_to_photon.mjs --npm FOLDER --folder SCENE --view FILE --words "a.rad b.rad" [--program lightwalk]
//         [--delay 0,100,250] [--ways press,drag] [--size 1280x720] [--presses 24] [--seconds 4] [--keep FOLDER]
//
// FOLDER has node_modules with playwright-core. `press`: an arrow key goes down at any moment between two refreshes, and up a tenth of a
// second later; `drag`: the pointer turns the eye, 120 steps a second. --keep leaves the traces. One line for each delay (of a round trip [ms])
// and way. Times are of the page's main thread [ms]; but for `answer` and `presented` they are its processor's, from which a rasteriser in
// software, which headless Chromium has, takes nothing:
//
//   first      share of the events whose answer, a camera drawn for an eye that has moved, is the first refresh after them [%]
//   handler    of an event, 95 %
//   script     of a refresh: the page's own, WebGL's calls included, median and 95 %
//   refresh    script, style, layout, painting, handing over to the compositor: median and 95 %
//   answer     from an event, on its way through Chromium, to the end of the refresh that answers it, by the clock: median and 95 %
//   presented  from an event to its picture on the screen, by the clock, as Chromium tells (EventLatency): median
//   frame      main thread for each frame that comes, between refreshes: messages, decoding, drawing it on the picture
//   longest    task of those, 95 %
//   gpu        processor time of Chromium's GPU process for each refresh: rasteriser and WebGL in software
//   refreshes  that draw the camera, a second; frames: of the server, a second
import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";
import {
    command_line,
    delayed,
    quantile,
    row_printer,
    settled,
    start_browser,
    start_server,
} from "./walk_setup.mjs";

const words = command_line({
    delay: "0,100,250",
    ways: "press,drag",
    presses: "24",
    seconds: "4",
    keep: undefined,
});
const { args, program, scene, size } = words;
const kCategories = ["toplevel", "devtools.timeline", "cc", "benchmark", "input"];
const kEvents = { press: ["keydown", "KEY_PRESSED"], drag: ["pointermove", "MOUSE_DRAGGED"] };

/** In the page: count the events of a type, and those that the first refresh after them answers. */
function count_answers(type) {
    const counts = (window.answers = { asked: 0, first: 0 });
    let waits = false;
    const text = ({ direction }) => String(direction);
    const asked = (event) => {
        if (waits || event.repeat) return;
        const before = text(window.lightwalk.eye);
        waits = true;
        // The page has asked for the same refresh before, so that it has drawn when this is called.
        requestAnimationFrame(() => {
            const { camera_draws, eye, shown_view } = window.lightwalk;
            const now = text(eye);
            ++counts.asked;
            if (camera_draws && now !== before && text(shown_view) === now) ++counts.first;
            waits = false;
        });
    };
    addEventListener(type, asked, { capture: true });
}

/** Ways of the hand; each begins and ends with the eye at rest. */
const kHands = {
    async press(page) {
        for (let k = 0; k < Number(args.presses); ++k) {
            await page.keyboard.down(k % 4 < 2 ? "ArrowRight" : "ArrowLeft");
            await page.waitForTimeout(100);
            await page.keyboard.up(k % 4 < 2 ? "ArrowRight" : "ArrowLeft");
            await page.waitForTimeout(200 + 100 * Math.random());
        }
    },
    async drag(page) {
        const [x, y] = size.map((pixels) => pixels / 2);
        await page.mouse.move(x, y);
        await page.mouse.down();
        const begin = performance.now();
        for (let t = 0; t < Number(args.seconds); t = (performance.now() - begin) / 1000) {
            await page.mouse.move(x * (1 + 0.8 * Math.sin(1.5 * t)), y);
            await page.waitForTimeout(1000 / 120);
        }
        await page.mouse.up();
    },
};

/** Trace what happens meanwhile; returns Chromium's trace events. */
async function traced(line, act) {
    const traceConfig = { includedCategories: kCategories };
    await line.send("Tracing.start", { transferMode: "ReturnAsStream", traceConfig });
    await act();
    const complete = new Promise((resolve) => line.once("Tracing.tracingComplete", resolve));
    await line.send("Tracing.end");
    const { stream } = await complete;
    const parts = [];
    for (let end = false; !end;) {
        const { data, eof, base64Encoded } = await line.send("IO.read", { handle: stream });
        parts.push(Buffer.from(data, base64Encoded ? "base64" : "utf8"));
        end = eof;
    }
    await line.send("IO.close", { handle: stream });
    return JSON.parse(Buffer.concat(parts).toString()).traceEvents;
}

/** Processor time that the browser's processes of a type have taken [ms]. */
async function processor_ms(line, type) {
    const { processInfo } = await line.send("SystemInfo.getProcessInfo");
    const own = processInfo.filter((one) => one.type === type);
    return 1000 * own.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

const ms = (us) => us / 1000;
const spent = (event) => ms(event.tdur ?? 0);
const end_of = (event) => event.ts + event.dur;
const is_within = (event, { ts, dur }) => event.ts >= ts && event.ts < ts + dur;

/** For each of `inner` the one of `outer` that it is within; both in the order of time, and those of `outer` apart from each other. */
function parents(inner, outer) {
    let k = 0;
    return inner.map((event) => {
        while (k < outer.length && end_of(outer[k]) <= event.ts) ++k;
        return k < outer.length && is_within(event, outer[k]) ? outer[k] : null;
    });
}

/** What belongs to the thread on which the page's script runs, in the order of time. */
function main_thread(trace) {
    const scripts = new Map();
    for (const { name, pid, tid } of trace)
        if (name === "FireAnimationFrame")
            scripts.set(`${pid} ${tid}`, 1 + (scripts.get(`${pid} ${tid}`) ?? 0));
    const [thread] = [...scripts].sort((a, b) => b[1] - a[1])[0] ?? [];
    return trace
        .filter(({ ph, pid, tid }) => ph === "X" && `${pid} ${tid}` === thread)
        .sort((a, b) => a.ts - b.ts || b.dur - a.dur);
}

/** When events of a kind happened, and when what they changed was on the screen, as the browser tells: {ts, end} [us]. */
function event_latencies(trace, kind) {
    const begun = new Map();
    const found = [];
    for (const { name, ph, pid, id2, ts, args: told } of trace) {
        if (name !== "EventLatency") continue;
        const id = `${pid} ${id2?.local}`;
        if (ph === "b" && told.event_latency?.event_type === kind) begun.set(id, ts);
        if (ph === "e" && begun.has(id)) found.push({ ts: begun.get(id), end: ts });
        if (ph === "e") begun.delete(id);
    }
    return found;
}

/** Figures of a trace while the hand went one way. */
function figures_of(trace, [type, kind]) {
    const main = main_thread(trace);
    const named = (name) => main.filter((event) => event.name === name);
    const refreshes = named("ProxyMain::BeginMainFrame");
    const scripts = new Map(refreshes.map((refresh) => [refresh, 0]));
    const fired = named("FireAnimationFrame");
    parents(fired, refreshes).forEach((refresh, k) => {
        if (refresh) scripts.set(refresh, scripts.get(refresh) + spent(fired[k]));
    });
    const drawn = refreshes.filter((refresh) => scripts.get(refresh) > 0);
    const events = named("EventDispatch").filter(({ args: told }) => told.data?.type === type);
    const latencies = event_latencies(trace, kind);
    const answers = latencies.map(({ ts }) => {
        const handled = events.find((event) => event.ts >= ts);
        const refresh = handled && drawn.find((one) => end_of(one) > end_of(handled));
        return refresh ? ms(end_of(refresh) - ts) : NaN;
    });
    // Tasks are not nested on this thread, but for loops within tasks, which these do not begin.
    const tasks = named("ThreadControllerImpl::RunTask");
    const busy = new Set(
        parents(
            [...refreshes, ...events].sort((a, b) => a.ts - b.ts),
            tasks,
        ),
    );
    const between = tasks.filter((task) => !busy.has(task)).map(spent);
    const both = (name, list) => ({
        [name]: quantile(list, 0.5),
        [`${name} 95 %`]: quantile(list, 0.95),
    });
    return {
        handler: quantile(events.map(spent), 0.95),
        ...both(
            "script",
            [...scripts.values()].filter((time) => time > 0),
        ),
        ...both("refresh", drawn.map(spent)),
        ...both("answer", answers.filter(Number.isFinite)),
        presented: quantile(
            latencies.map(({ ts, end }) => ms(end - ts)),
            0.5,
        ),
        between,
        refreshes: drawn.length,
    };
}

async function measure(browser, address, delay, way) {
    const context = await browser.newContext({ viewport: { width: size[0], height: size[1] } });
    const page = await context.newPage();
    await page.goto(address);
    await settled(page, 1000);
    await page.focus("#picture");
    await page.evaluate(count_answers, kEvents[way][0]);
    const line = await browser.newBrowserCDPSession();
    const counters = () =>
        page.evaluate(() => {
            const { frames, refreshes } = window.lightwalk;
            return { frames, refreshes, now: performance.now() };
        });
    let before, after, gpu;
    const trace = await traced(line, async () => {
        gpu = await processor_ms(line, "GPU");
        before = await counters();
        await kHands[way](page);
        after = await counters();
        gpu = (await processor_ms(line, "GPU")) - gpu;
    });
    const { asked, first } = await page.evaluate(() => window.answers);
    if (args.keep)
        await writeFile(path.join(args.keep, `${way}-${delay}.json`), JSON.stringify(trace));
    await context.close();
    const { between, refreshes, ...figures } = figures_of(trace, kEvents[way]);
    const seconds = (after.now - before.now) / 1000;
    const frames = after.frames - before.frames;
    return {
        delay,
        way,
        first: (100 * first) / asked,
        ...figures,
        frame: between.reduce((sum, x) => sum + x, 0) / frames,
        longest: quantile(
            between.filter((time) => time > 0.5),
            0.95,
        ),
        gpu: gpu / refreshes,
        refreshes: (after.refreshes - before.refreshes) / seconds,
        frames: frames / seconds,
    };
}

if (args.keep) await mkdir(args.keep, { recursive: true });
const [server, url] = await start_server(program, scene);
const browser = await start_browser(words);
const print_row = row_printer();
try {
    for (const delay of args.delay.split(",").map(Number)) {
        const proxy = await delayed(Number(url.port), delay);
        for (const way of args.ways.split(",")) {
            const address = `http://127.0.0.1:${proxy.address().port}/`;
            print_row(await measure(browser, address, delay, way));
        }
        proxy.close();
    }
} finally {
    await browser.close();
    server.kill();
}
