// What tests and curious people may look at: window.lightwalk.

/** Counters and newest answers; `session` and `navigator` are looked at when asked. */
export function make_counters(session, navigator) {
    return {
        frames: 0, ///< drawn
        skipped: 0, ///< superseded before they were drawn
        exposure: 0, ///< factor of the newest frame
        at_rest: false,
        final: false, ///< the newest frame is as good as it gets
        last_pick: null,
        last_mean: null,
        last_glare: null,
        last_probes: null,
        state: {}, ///< the server's newest
        errors: [],
        scene: "",
        ready: false, ///< the scene is loaded and its picture on the screen
        get view_id() {
            return session.view_id;
        },
        get shown_view_id() {
            return session.shown_id;
        },
        get view() {
            return session.view;
        },
        get shown_view() {
            return session.shown;
        },
        get latency() {
            return session.latency.samples;
        }, ///< [ms]
        get bytes() {
            return session.connection.bytes;
        },
        get connected() {
            return session.connection.connected;
        },
        get driving() {
            return session.driving;
        },
        get moving() {
            return navigator.moving;
        },
        get walking() {
            return navigator.walk;
        },
    };
}
