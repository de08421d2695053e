"use strict";
(() => {
  const data = JSON.parse(document.getElementById("frames").textContent);
  const byId = (id) => document.getElementById(id);
  const picture = byId("picture");
  if (!picture) return;
  const last = data.times.length - 1;
  const length = data.times[last];
  let frame = 0;
  let timer = null;

  const show = (number) => {
    frame = Math.min(Math.max(number, 0), last);
    const camera = data.cameras[byId("camera").selectedIndex] || data.cameras[0];
    picture.src = data.pictures[camera.frames[frame]];
    byId("slider").value = frame;
    const time = data.times[frame];
    byId("time").textContent = `${time.toFixed(2)} of ${length.toFixed(2)} s`;
    const part = data.parts.filter(([since]) => since <= frame).pop();
    byId("part").textContent = part ? part[1] : "";
    for (const head of document.querySelectorAll(".head")) {
      head.style.left = `${length > 0 ? (time / length) * 100 : 0}%`;
    }
    for (const svg of document.querySelectorAll(".plot svg")) {
      const [left, right, seconds] = ["left", "right", "seconds"].map((name) => Number(svg.dataset[name]));
      const x = left + (Math.min(time, seconds) / seconds) * (right - left);
      svg.querySelector(".playhead").setAttribute("transform", `translate(${x - left} 0)`);
    }
  };

  const goTo = (time) => {
    let nearest = 0;
    data.times.forEach((at, number) => {
      if (Math.abs(at - time) < Math.abs(data.times[nearest] - time)) nearest = number;
    });
    show(nearest);
  };

  const pause = () => {
    clearTimeout(timer);
    timer = null;
    byId("play").textContent = "Play";
  };

  const next = () => {
    if (frame >= last) return pause();
    const wait = ((data.times[frame + 1] - data.times[frame]) * 1000) / Number(byId("speed").value);
    timer = setTimeout(() => {
      show(frame + 1);
      next();
    }, wait);
  };

  const playOrPause = () => {
    if (timer !== null) return pause();
    if (frame >= last) show(0);
    byId("play").textContent = "Pause";
    next();
  };

  const stepTo = (number) => {
    pause();
    show(number);
  };

  byId("play").addEventListener("click", playOrPause);
  byId("first").addEventListener("click", () => stepTo(0));
  byId("last").addEventListener("click", () => stepTo(last));
  byId("back").addEventListener("click", () => stepTo(frame - 1));
  byId("on").addEventListener("click", () => stepTo(frame + 1));
  byId("slider").addEventListener("input", (event) => stepTo(Number(event.target.value)));
  byId("camera").addEventListener("change", () => show(frame));
  for (const button of document.querySelectorAll("button[data-time]")) {
    button.addEventListener("click", () => {
      pause();
      goTo(Number(button.dataset.time));
    });
  }
  for (const svg of document.querySelectorAll(".plot svg")) {
    svg.addEventListener("click", (event) => {
      const [left, right, seconds] = ["left", "right", "seconds"].map((name) => Number(svg.dataset[name]));
      const box = svg.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * svg.viewBox.baseVal.width;
      pause();
      goTo(((x - left) / (right - left)) * seconds);
    });
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const target = event.target.tagName;
    if (target === "SELECT") return;
    const act = {
      " ": target === "BUTTON" ? null : playOrPause,
      ArrowLeft: () => stepTo(frame - 1),
      ArrowRight: () => stepTo(frame + 1),
      Home: () => stepTo(0),
      End: () => stepTo(last),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  show(0);
})();
