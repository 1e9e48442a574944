// Saves the picture as a file, and copies its command line.

import { addressOf, send } from "./server.js";

/** Downloads the picture of a side as "png" or "exr". Throws an Error with the server's message. */
export async function savePicture({ options, number }, format) {
  const response = await send("POST", addressOf("file", { format, scene: number }), options.words.join("\n"));
  const name = /filename="([^"]*)"/.exec(response.headers.get("Content-Disposition"))?.[1] ?? "picture";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await response.blob());
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** Copies an element's text to the clipboard. */
export async function copyTextOf(element) {
  try {
    await navigator.clipboard.writeText(element.textContent);
  } catch {
    // Browsers refuse in frames and for addresses that they don't trust. The text is then selected for the user.
    getSelection().selectAllChildren(element);
  }
}
