// window.lightwalk: counters and the newest answers, for tests and for the browser's console.

/** The object window.lightwalk; what it takes from `session`, `navigator`, `camera` and `decoder` is read at each access. */
export function make_counters(session, navigator, camera, decoder) {
    return {
        frames: 0, ///< frames that were drawn
        skipped: 0, ///< frames that a newer one superseded before they were drawn
        exposure: 0, ///< factor that the newest frame's radiance was multiplied by
        at_rest: false,
        final: false, ///< whether the newest frame is the final one of its view: nothing will be refined any more
        last_pick: null,
        last_mean: null,
        last_glare: null,
        last_probes: null,
        last_isolux: null,
        last_material: null,
        last_edited: null,
        last_followed: null,
        last_time: null,
        state: {}, ///< the server's newest `state` message
        errors: [],
        interruptions: [], ///< why the walk began anew, each time
        scene: "",
        beside: null, ///< what is compared with the walk: {frames, final, at_rest, state, session}; null: nothing
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
        get eye() {
            return navigator.view;
        }, ///< the view that is to be seen
        get frame_view() {
            return session.frame_view;
        },
        get camera_draws() {
            return camera.draws;
        }, ///< whether the screen shows what the page has drawn from frames, not a frame
        get refines() {
            return camera.refines;
        }, ///< whether small frames are refined by those before them
        get decodes_beside() {
            return decoder.beside;
        }, ///< whether a worker decodes frames, not the page
        get refreshes() {
            return camera.refreshes;
        }, ///< of the screen for which it has
        get shown_view() {
            return session.shown;
        },
        get latency() {
            return session.latency.samples;
        }, ///< from input to picture [ms]
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
            return navigator.moving || navigator.has_news;
        }, ///< the eye moves, or a view of it waits to be sent
        get walking() {
            return navigator.walk;
        },
    };
}
