// Unpacks what report/page/parts.h packed (base64 of a zlib stream of UTF-8) by the browser's own means, which all browsers have since May 2023.
// SPDX-License-Identifier: Apache-2.0

export async function unpacked(id) {
  const letters = atob(document.getElementById(id).textContent), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  const { readable, writable } = new DecompressionStream("deflate"), writer = writable.getWriter();
  const written = Promise.all([writer.write(bytes), writer.close()]);
  const text = await new Response(readable).text(); // This throws where the stream is damaged.
  await written;
  return text;
}

// Tells of a failure: to the reader, who sees tables at most, and on the console.
export function failed(error) {
  const note = document.createElement("p");
  note.className = "note failed";
  note.textContent = typeof DecompressionStream === "undefined" ? "The figures need a browser of 2023 or later: Chrome 80, Firefox 113, Safari 16.4." : `This page is damaged; make it again. (${error})`;
  document.getElementById("figures").append(note);
  throw error;
}
