// The connection to the server: one WebSocket, opened again when it breaks.

const kFirstWait = 250,
    kLongestWait = 5000; // [ms]

/** How long to wait before attempt number `attempt` (0, 1, ...) to connect [ms]: exponential backoff. */
export const wait_before = (attempt) => Math.min(kLongestWait, kFirstWait * 2 ** attempt);

/** The WebSocket's address, from that of the page: same host, same folder, same token. */
export function socket_address(page) {
    const address = new URL("walk", page);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    address.search = token_query(page);
    return address.href;
}

/** "?token=..." if the page's address has a token, else "". */
export function token_query(page) {
    const token = new URL(page).searchParams.get("token");
    return token ? `?token=${encodeURIComponent(token)}` : "";
}

export class Connection {
    /**
     * @param address  of the WebSocket
     * @param on  {open(), message(object), frame(buffer), lost(reason, wait)}: wait: time until the next attempt [ms]
     */
    constructor(address, on) {
        this.address_ = address;
        this.on_ = on;
        this.attempt_ = 0;
        this.reason_ = "";
        this.bytes = 0;
        this.open_();
    }

    get connected() {
        return this.socket_?.readyState === WebSocket.OPEN;
    }

    send(message) {
        if (!this.connected) return false;
        this.socket_.send(JSON.stringify(message));
        return true;
    }

    /** Connect now instead of waiting: the network is back, or the page is visible again. */
    hurry() {
        if (this.timer_ === undefined) return;
        clearTimeout(this.timer_);
        this.open_();
    }

    /** For good. */
    close() {
        this.closed_ = true;
        clearTimeout(this.timer_);
        this.timer_ = undefined;
        this.socket_.close();
    }

    open_() {
        this.timer_ = undefined;
        const socket = new WebSocket(this.address_);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => {
            if (this.closed_) return socket.close();
            this.reason_ = "";
            this.on_.open();
        };
        socket.onmessage = (event) => this.receive_(event.data);
        socket.onclose = (event) => this.lost_(event.reason);
        this.socket_ = socket;
    }

    receive_(data) {
        if (this.closed_) return;
        // A server that accepts and at once closes again must not be asked without pause: backoff starts anew only
        // after a message has arrived.
        this.attempt_ = 0;
        if (typeof data !== "string") {
            this.bytes += data.byteLength;
            return this.on_.frame(data);
        }
        this.bytes += data.length;
        let message;
        try {
            message = JSON.parse(data);
        } catch {
            return console.warn("lightwalk: the server sent what is no JSON");
        }
        if (message.type === "bye") {
            this.reason_ = message.reason || "";
            this.attempt_ = 3;
        }
        this.on_.message(message);
    }

    lost_(reason) {
        if (this.closed_) return;
        const wait = wait_before(this.attempt_++);
        this.timer_ = setTimeout(() => this.open_(), wait);
        this.on_.lost(this.reason_ || reason || "", wait);
    }
}
