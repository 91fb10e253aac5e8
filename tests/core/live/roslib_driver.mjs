// Drives with roslib (JavaScript) as `Straight` of pursuit.py does.
//
// Usage: node roslib_driver.mjs NODE_MODULES PORT
const [folder, port] = process.argv.slice(2);
const ROSLIB = await import(`file://${folder}/roslib/dist/RosLib.js`);

const ENDED = ["arrived", "timeout", "toppled", "planner_failed"];
const ros = new ROSLIB.Ros({ url: `ws://127.0.0.1:${port}` });
const topic = (name, messageType) => new ROSLIB.Topic({ ros, name, messageType });
const command = topic("/cmd_vel", "geometry_msgs/msg/Twist");
let goal = [0, 0];

topic("/crowdbot/task", "crowdbot_msgs/msg/Task").subscribe((m) => {
  goal = m.goal;
});
topic("/crowdbot/status", "crowdbot_msgs/msg/LiveStatus").subscribe((m) => {
  if (ENDED.includes(m.state)) process.exit(0);
});
topic("/crowdbot/observation", "crowdbot_msgs/msg/Observation").subscribe((m) => {
  const w = 0.5 * (goal[1] - m.pose[1]) - m.pose[2];
  command.publish({ linear: { x: 0.6, y: 0, z: 0 }, angular: { x: 0, y: 0, z: w } });
});
ros.on("connection", () => command.advertise());
ros.on("error", (error) => {
  console.error(String(error));
  process.exit(1);
});
