/** Where a page takes a run from.  A source has async meta(), frame(i) (an ArrayBuffer) and table(name), and may have
 *  others: sources of further runs to compare with.  This one reads them from the page itself. */

export class Embedded {
  /** places : name -> [start, length] in text, base64 of deflated contents. */
  constructor(places, text) {
    this.places = places;
    this.text = text;
    this.others = [];
  }

  async meta() {
    return JSON.parse(new TextDecoder().decode(await this.read("meta")));
  }

  async frame(i) {
    return this.read(`frame ${i}`);
  }

  async table(name) {
    return JSON.parse(new TextDecoder().decode(await this.read(`table ${name}`)));
  }

  async read(name) {
    if (!(name in this.places)) throw new Error(`${name} is not in this page`);
    const [start, length] = this.places[name];
    return inflate(this.text.slice(start, start + length));
  }
}

/** The bytes that base64 of a zlib stream holds. */
export async function inflate(text) {
  const signs = atob(text);
  const bytes = new Uint8Array(signs.length);
  for (let k = 0; k < signs.length; k++) bytes[k] = signs.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}
