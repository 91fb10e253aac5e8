// The connection to the run: opens, breaks, opens again.

const AGAIN = 500; // ms
const link = { socket: null, open: false, over: false, on: {} };

/** Sends a message; returns false while there is no connection. */
function send(op, fields = {}) {
  if (!link.open) return false;
  link.socket.send(JSON.stringify({ op, ...fields }));
  return true;
}

/** Connects and stays connected; `on` has a function for each kind of message, and for open, close. */
function connect(on) {
  link.on = on;
  const address = new URL("/socket", location.href);
  address.protocol = "ws:";
  address.search = location.search;
  const socket = new WebSocket(address);
  link.socket = socket;
  socket.onopen = () => {
    link.open = true;
    on.open();
  };
  socket.onmessage = ({ data }) => {
    const message = JSON.parse(data);
    on[message.op]?.(message);
  };
  socket.onclose = () => {
    link.open = false;
    on.close();
    if (!link.over) setTimeout(() => connect(on), AGAIN);
  };
}
