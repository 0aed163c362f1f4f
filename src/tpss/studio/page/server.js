// What the page asks the server, relative to its own address, which holds the token.

export class Refused extends Error {
  constructor(told) {
    super(told.refused);
    this.told = told;
  }
}

export class Lost extends Error {}

export async function ask(name, body = {}, signal = undefined) {
  let answer;
  try {
    answer = await fetch(`api/${name}`, {
      method: "POST", body: JSON.stringify(body), signal, headers: { "Content-Type": "application/json" },
    });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Lost("The server does not answer.");
  }
  const told = await answer.json().catch(() => ({ refused: `the server answered ${answer.status}` }));
  if ("refused" in told) throw new Refused(told);
  return told;
}

export async function isReady() {
  const answer = await fetch("api/ready");
  return (await answer.json()).ready;
}
