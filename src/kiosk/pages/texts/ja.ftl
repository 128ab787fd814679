# 日本語

language-name = 日本語

## What visitors read

invite = そっと息を吹きかけてください
hold = 長押しすると風が吹きます
no-breath = 本日は息を吹きかけず、長押しで風を送ってください
privacy = マイクは空気の動きだけを測ります。録音はしません。
more = もっと見る
back = 作品に戻る
aim = 触れるか指し示すと、息の届く先に輪が現れます
take = 押したまま引くと、手で動かせます
press-twice = 押すと風が吹き、もう一度押すと止まります
dwell-twice = ポインターを止めると風が吹き、動かしてまた止めると風がやみます
look-round = まわりから見る
look-round-drag = 作品の横をドラッグすると、まわりから見られます
look-round-press = 作品の横を押すと、まわりから見られます
large-text = 大きな文字
high-contrast = 高コントラスト
microphone = マイク
press-once = 一度押し
dwell = 止めて押す
less-motion = 動きを減らす
read-aloud = 読み上げ
microphone-off = マイクはオフです。
sound-off = 音はオフです。
no-sound = この作品は音が出ません。
take-a-rest = 少し休んで、ゆっくり息をしてください。
stay = 続けるには触れるか息を吹きかけてください
stay-touch = 続けるには触れてください
cleaning = 画面を清掃しています

## What is read aloud of buttons that show only a sign

louder = 音を大きく
softer = 音を小さく
next-page = 次の作品
previous-page = 前の作品
on = オン
off = オフ

## The staff panel: its frame

staff-page-status = 状態
staff-page-exhibits = 作品
staff-page-bodies = 物体
staff-page-wind = 風
staff-page-sound = 音
staff-page-parameters = パラメーター
staff-page-microphone = マイク
staff-page-test = テスト
staff-page-log = ログ
staff-no-pin = PIN が設定されていません。このパネルはすべてを表示しますが、何も変更しません。`soffio pin` を実行し、表示された行を [staff] の下に入れてください。
staff-saved-in = { $file } に保存しました。
staff-enter-pin = スタッフ用：PIN を入力してください
staff-pin-checking = 確認中
staff-pin-wrong = { $count ->
   *[other] PIN が違います（連続 { $count } 回）。{ $seconds } 秒後にもう一度入力してください。
}

## Staff: status

staff-clean = 画面を清掃
staff-mute = 消音
staff-unmute = 音を出す
staff-night = 夜間
staff-reset = リセット
staff-reload = 作品を再読み込み
staff-open-now = 今すぐ開館
staff-close-again = 再び閉館
staff-audio-self-test = 音響自己診断
staff-new-foam = 風防を交換した
staff-new-reference = 新しい基準
staff-end = キオスクを終了
staff-configuration-says = 設定：{ $message }
staff-microphone-says = マイク：{ $message }
staff-venue = 美術館
staff-venue-open = 開館中
staff-venue-early = 開館時刻の前にスタッフが開けた
staff-venue-closed = 閉館中
staff-breath-wanted = 息
staff-breath-allowed = 可
staff-breath-off = オフ：来館者は長押しする
staff-exhibit = 作品
staff-microphone = マイク
staff-microphone-dual = { $device }、2 マイク
staff-device-starting = 起動中
staff-device-ok = { $name }、{ $rate } Hz
staff-device-missing = なし：{ $reason }
staff-device-closed = 停止中
staff-level = レベル
staff-level-floor = { $level } dBFS、暗騒音 { $floor } dBFS
staff-no-signal = 信号なし
staff-clipping = クリッピング
staff-clips = { $count ->
   *[other] { $count } 回、うち息なし { $without } 回
}
staff-foam = 風防
staff-foam-breaths = { $count ->
   *[other] 息 { $count } 回
}
staff-foam-breaths-of = { $limit ->
   *[other] 息 { $limit } 回のうち { $count } 回
}
staff-self-test = 音響自己診断
staff-self-test-none = 未実施
staff-self-test-when = { $verdict }；{ $when }
staff-self-test-good = 風防、スピーカー、マイクは以前と同じ（{ $db } dB）
staff-self-test-learning = 基準測定 { $number } / { $count }
staff-self-test-wet-foam = 風防が湿っているか、ほこりがある：高い音が { $db } dB 小さい。交換してください。
staff-self-test-blocked = 全体が { $db } dB 小さい：風防、障害物、ゲインを確認してください
staff-self-test-louder = 全体が { $db } dB 大きい：ゲインが上げられた。意図したものなら「新しい基準」を押してください。
staff-self-test-dead = マイクの信号なし：ケーブル、スイッチ、電源を確認してください
staff-self-test-not-detected = テスト音が届かない：スピーカーとアンプを確認してください
staff-self-test-noisy = 周囲の音が大きく、測定できなかった
staff-self-test-failed = 実施できなかった：{ $reason }
staff-gain-control = 自動ゲイン
staff-gain-control-detected = 検出
staff-gain-control-none = 検出されず
staff-heard = この場所での検出
staff-heard-of = { $distance } cm で { $of } 回中 { $detected } 回の息を検出
staff-heard-unknown = 未測定：息を10回録音し、soffio breath fit を実行してください
staff-gusts = 隙間風とドア
staff-gusts-cost = 息にとって { $db } dB の損失
staff-detector = 検出器
staff-detector-state = { $reason }、{ $confidence }
staff-breath = 息
staff-breath-speeds = 検出 { $detected } m/s、空気中 { $blown } m/s
staff-reason-no-signal = 信号なし
staff-reason-settling = 暗騒音を学習中
staff-reason-quiet = 静か
staff-reason-voiced = 声または音楽
staff-reason-other-sound = 息とは異なる
staff-reason-pending = 息の可能性
staff-reason-blow = 息
staff-reason-masked = キオスク自身の音
staff-reason-fault = 不正なサンプル
staff-wind-force = 風の力
staff-attract = デモ
staff-attract-playing = 再生中
staff-attract-waiting = 待機中
staff-joint-error = 関節の誤差
staff-energy = エネルギー
staff-substeps = サブステップ
staff-impacts = 衝突
staff-faults = 障害
staff-step = ステップ
staff-step-time = { $limit } ms のうち { $ms } ms
staff-motion = 運動
staff-motion-changes = { $count ->
   *[other] { $mode }、切り替え { $count } 回
}
staff-motion-dynamics = 拘束付き動力学
staff-motion-procedural = 手続き型
staff-motion-position-based = 位置ベース
staff-pointer-grabs = 手で持たれた箇所
staff-steps-dropped = 省かれたステップ
staff-commands-dropped = 失われた命令
staff-picture = 画面
staff-wind-to-picture = 風から画面まで
staff-graphics = グラフィックス
staff-loudspeaker = スピーカー
staff-hearing-loop = 磁気ループ
staff-step-to-sound = ステップから音まで
staff-sound-delay = { $total } ms：ステップ { $step }、ブロック { $block }、リミッター { $limiter }、機器 { $device }
staff-sound-delay-unknown = { $total } ms：ステップ { $step }、ブロック { $block }、リミッター { $limiter }、機器は不明
staff-block = ブロック
staff-block-is = { $ms } ms、設定 { $wanted } ms
staff-block-shorter = { $ms } ms、設定 { $wanted } ms；ここでは audio.block_ms = { $possible } も可能です
staff-block-shortest = { $ms } ms、設定 { $wanted } ms；この機器の最短は { $shortest } ms
staff-late-blocks = 遅れたブロック
staff-sounds-lost = 失われた音
staff-volume = 音量
staff-volume-is = { $db } dB、来館者の調整 { $steps }
staff-volume-attenuated = { $volume }、{ $db } dB 減衰
staff-volume-muted = { $volume }、消音
staff-sound-of-the = 音のモード
staff-sound-day = 昼間
staff-sound-night = 夜間
staff-sound-by-hours = { $mode }、時刻による
staff-sound-by-staff = { $mode }、スタッフによる
staff-level-minute = レベル、1 分
staff-level-day = レベル、1 日
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = フルスケール基準 { $db } dB(A)、未校正
staff-level-silent = 無音

## Staff: exhibits

staff-exhibits-order = 来館者には作品がこの順に表示されます。
staff-save-order = 順序を保存
staff-discard = 取り消し
staff-no-file = 設定は内蔵のものです。ファイルがないと保存できません。
staff-others = その他すべて
staff-others-count = その他すべて（{ $count }）
staff-exhibit-missing = { $id }（見つからないか、読み込めません：ログを参照）
staff-not-listed = 一覧にないもの：

## Staff: bodies and joints

staff-largest-joint-error = 関節の最大誤差
staff-no-data-yet = シミュレーションのデータはまだありません
staff-joints = 関節：押すとグラフを表示します
staff-column-body = 物体
staff-column-mass = 質量、g
staff-column-speed = 速さ、m/s
staff-column-spin = 回転、rad/s
staff-column-height = 高さ、m

## Staff: wind

staff-wind-help = それぞれの点は風を受ける面の一部です。輪は、今の狙いでの息の円錐の中にあり、唇から見える部分を示します。赤いほど空気は速く動きます。
staff-column-surface = 面の物体
staff-column-hit = 命中
staff-column-mean = 平均、m/s
staff-column-fastest = 最大、m/s
staff-hit-of = { $count } のうち { $hit }
staff-total-force = 風の力の合計：{ $newtons } N
staff-source-speed = 息の出口での速さ：{ $speed } m/s

## Staff: sound

staff-nothing-audible = 音は出ません：消音中か、スピーカーがありません
staff-strike-speed = 打つ速さ、m/s
staff-pan = 左 … 右
staff-all-timbres = すべての音色（それぞれ試験用の物体で）

## Staff: parameters

staff-does-not-load = 保存したファイルを読み込めません。最後の正常な版を表示しています。変更を元に戻すか、直してください：
staff-parameters-help = { $file }。数値をドラッグするか、押して入力します。離すと保存されます。
staff-undo = 元に戻す（{ $count }）
staff-undone = 元に戻しました。
staff-find = 検索
staff-saved-value = 保存しました：{ $value }。

## Staff: microphone

staff-no-signal-from = 信号なし；{ $device }
staff-level-now = 現在のレベル
staff-level-range = ページを開いてから
staff-from-to = { $low } ～ { $high } dBFS
staff-noise-floor = 暗騒音
staff-breath-at-lips = 唇での息
staff-microphones = マイクの数
staff-all-well = 直すところはありません。
staff-measure-again = 範囲を測り直す
staff-sensitivity = breath.sensitivity_db：息をどれだけ強いとみなすか
staff-calibrate = 息で校正
staff-calibrate-blow = { $count ->
   *[other] 来館者の立つ位置から、来館者と同じように 1～2 秒マイクに息を吹きかけてください。あと { $count } 回。
}
staff-stop = 中止
staff-calibrated = 普通の息だったなら：{ $now } dB の代わりに { $proposed } dB。
staff-apply = 適用
staff-dismiss = 無視
staff-remedy-gain-control = 自動ゲインを切ってください：システムのミキサー（“Auto Gain”、“AGC”）、マイクのソフトウェア、または機器で。
staff-remedy-clipping = クリッピングしています：入力ゲインを下げてください。
staff-remedy-muted = 消音されています：システムのミキサーで入力を有効にしてください。
staff-remedy-loud = 静かな部屋としては大きすぎます：入力ゲインを下げてください。

## Staff: test

staff-glass = タッチ画面
staff-glass-help = { $count ->
   *[other] 一本または複数の指で画面を押すと、輪が追います。現在 { $count } 本。
}
staff-clear-traces = 跡を消す
staff-display = ディスプレイ
staff-display-help = 灰色の階調、縁、そして不良画素を見つける色の順です。押すたびに次へ進みます。
staff-show-patterns = テスト画面を表示
staff-loudspeakers = スピーカー
staff-left = 左
staff-both = 両方
staff-right = 右
staff-decision = 判定
staff-decision-breath = 息
staff-decision-none = 息ではない
staff-because = 理由
staff-confidence = 確信度
staff-speed = 速さ
staff-grey-steps = 均等な 17 段階；黒と白の中に四角が五つずつ見えます
staff-edges = 四辺に 1 画素幅の白い線；丸い円が五つ

## Staff: log

staff-log-grave = 警告とエラーのみ
staff-log-empty = 行はありません
