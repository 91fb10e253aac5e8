"use strict";
// Reload when a drive has begun to be drivable, or has ended: the server says so.
const state = document.body.dataset.state;
const heading = document.querySelector("h1");
if (heading) heading.focus({ preventScroll: true });
if (state.startsWith("drive:")) {
  const ask = async () => {
    try {
      const reply = await fetch("state", { cache: "no-store" });
      if (reply.ok && (await reply.text()) !== state) return location.reload();
    } catch {
      document.querySelector(".status").textContent = "The runner does not answer; nothing is lost.";
    }
    setTimeout(ask, 1000);
  };
  setTimeout(ask, 1000);
}
document.documentElement.dataset.ready = "";
