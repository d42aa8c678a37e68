/** The page of a run in a notebook: a question is a message to the kernel, which answers with bytes. */

let asked = 0;

function kernel(model) {
  const waiting = new Map();
  model.on("msg:custom", ({ id, status }, [content]) => {
    const { done, failed } = waiting.get(id) ?? {};
    waiting.delete(id);
    if (!done) return;
    const view = new Uint8Array(content.buffer ?? content, content.byteOffset ?? 0, content.byteLength);
    if (status === 200) done(view.slice().buffer);
    else failed(new Refused(new TextDecoder().decode(view)));
  });
  return (name) => new Promise((done, failed) => {
    const id = `${Date.now()} ${asked++}`;
    waiting.set(id, { done, failed });
    model.send({ id, name: decodeURIComponent(name) });
  });
}

function render({ model, el }) {
  const root = el.attachShadow({ mode: "open" });
  const page = make("div");
  root.append(make("style", {}, CSS), page);
  follow(page, new Remote(kernel(model)), { ends: true });
  return () => page.remove();
}

export default { render };
