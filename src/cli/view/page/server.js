// Requests to the server. Addresses are relative, so the page also works behind a proxy.

/** Returns the response. Throws an Error with the server's message and the answer in JSON if the request failed. */
export async function send(method, path, body) {
  let response;
  try {
    response = await fetch(path, { method, body });
  } catch {
    throw new Error("The program does not answer. It may have ended; the page can't work without it.");
  }
  if (response.ok) return response;
  const text = await response.text();
  let answer = {};
  try {
    answer = JSON.parse(text);
  } catch {
    // The message is plain text.
  }
  throw Object.assign(new Error(answer.error ?? text), { status: response.status, answer });
}

export async function sendForJson(method, path, body) {
  return (await send(method, path, body)).json();
}

/** Returns the path with parameters. */
export function addressOf(path, parameters) {
  return `${path}?${new URLSearchParams(parameters)}`;
}

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/**
 * A picture that the server draws and refines. `show(bitmap, status)` receives each picture, `fail(message, status)` each
 * error; `status` describes what was drawn (docs/internals.md). `accepted()` is called when the server knows a request.
 */
export class LivePicture {
  #id = null;
  #wanted = null;
  #isSending = false;
  #isClosed = false;
  #awaited = 0;
  #firstCurrent = Infinity; // the first request that differs from the last one only by the camera's movement, if known

  constructor(scene, show, fail, accepted) {
    this.scene = scene;
    this.show = show;
    this.fail = fail;
    this.accepted = accepted;
  }

  /** Requests a picture with these words of a command line. Of several requests, only the last is sent. */
  request(words, isMoving = false) {
    this.#wanted = { words, isMoving };
    if (!isMoving) this.#firstCurrent = Infinity;
    this.#send();
  }

  /** Returns false if the status is that of an earlier request, apart from the camera's movement. */
  isCurrent(status) {
    return status.request >= this.#firstCurrent;
  }

  close() {
    this.#isClosed = true;
    if (this.#id !== null) fetch(`pictures/${this.#id}`, { method: "DELETE", keepalive: true }).catch(() => {});
  }

  async #send() {
    if (this.#isSending || this.#isClosed) return;
    this.#isSending = true;
    while (this.#wanted !== null && !this.#isClosed) {
      const { words, isMoving } = this.#wanted;
      this.#wanted = null;
      try {
        if (this.#id === null) await this.#open();
        const path = `pictures/${this.#id}${isMoving ? "?moving" : ""}`;
        const { request } = await sendForJson("PUT", path, words.join("\n"));
        this.#awaited = request;
        if (this.#wanted === null) this.#firstCurrent = Math.min(this.#firstCurrent, request);
        this.accepted();
        // The next picture of a moving camera is requested when this one is shown.
        if (isMoving) await this.#shown(request);
      } catch (error) {
        if (error.status === 410) {
          this.#id = null;
          this.#wanted ??= { words, isMoving };
        } else {
          this.fail(error.message, { request: this.#awaited });
        }
      }
    }
    this.#isSending = false;
  }

  async #open() {
    this.#id = (await sendForJson("POST", addressOf("pictures", { scene: this.scene }))).id;
    this.#firstCurrent = Infinity; // each picture counts its own requests
    this.#receive(this.#id);
  }

  #shown(request) {
    return new Promise((resolve) => {
      this.resolve = (status) => {
        if (status.request >= request) resolve();
      };
      setTimeout(resolve, 2000);
    });
  }

  async #receive(id) {
    let after = 0;
    while (this.#id === id && !this.#isClosed) {
      try {
        const response = await send("GET", addressOf(`pictures/${id}`, { after }));
        if (response.status === 204) continue;
        const status = JSON.parse(response.headers.get("Microtrace-Picture"));
        after = status.sequence;
        if (response.headers.get("Content-Type") === "application/json") {
          this.fail((await response.json()).error, status);
        } else {
          const options = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
          const bitmap = await createImageBitmap(await response.blob(), options);
          if (!this.#isClosed) this.show(bitmap, status);
          bitmap.close();
        }
        this.resolve?.(status);
      } catch (error) {
        if (this.#isClosed) return;
        if (error.status === 410) {
          this.#id = null;
          return;
        }
        this.fail(error.message, { request: this.#awaited });
        await pause(1000);
      }
    }
  }
}
