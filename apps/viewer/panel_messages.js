// What the panels do with messages of the side that they show, see Sides.

/** @param parts  () => {session, counters, measuring, materials, lamps, time, commands, open_panels(message)}: of the page */
export const panel_messages = (parts) => ({
    loaded: (message) => parts().open_panels(message),
    state(message) {
        const { time, materials } = parts();
        time.follow(message);
        materials.follow_light();
    },
    probes: (message) => parts().measuring.probes(message),
    material(message) {
        const { counters, materials } = parts();
        counters.last_material = message;
        materials.answer(message);
    },
    edited(message) {
        const { session, counters, materials, commands } = parts();
        counters.last_edited = message;
        materials.take(message);
        if (!session.driving) commands.follow_light("a material is changed");
    },
    lights(message) {
        const { session, lamps, commands } = parts();
        if (session.driving && lamps.touched) return;
        lamps.take(message);
        commands.follow_light("a lamp is dimmed");
    },
    time(message) {
        const { counters, time, commands } = parts();
        counters.last_time = message;
        time.take(message);
        commands.follow_light("the time is another one");
    },
});
