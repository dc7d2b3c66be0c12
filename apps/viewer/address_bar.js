// The address of the page and the browser's history, for views (address.js).
import { Address, fragment_view } from "./address.js";

const kInterval = 150; // between two looks at the eye [ms]

export class AddressBar {
    /** @param go  (view): goes to the view of an address that the browser has changed */
    constructor(session, navigator, go) {
        this.address_ = new Address((fragment, fresh) => {
            const here = `${location.pathname}${location.search}${fragment}`;
            if (fresh) history.pushState(null, "", here);
            else history.replaceState(null, "", here);
        });
        this.address_.read(location.hash);
        // Back, Forward, and an address that somebody types.
        addEventListener("popstate", () => {
            this.address_.read(location.hash);
            if (this.view) go(this.view);
        });
        setInterval(() => {
            if (session.driving && session.view && navigator.view)
                this.address_.follow(navigator.view, navigator.moving, performance.now());
        }, kInterval);
    }

    /** The view in the page's address; null when there is none. */
    get view() {
        return fragment_view(location.hash);
    }

    choose() {
        this.address_.choose();
    }
}
